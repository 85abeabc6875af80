"""Memory allocator settings, so that memory of dropped maps returns to the system."""

import ctypes
from contextlib import suppress

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8
"""Parameters of glibc's mallopt, as malloc.h counts them."""

LARGE = 2 << 20
"""Size from which an array is mapped by itself and returned as soon as it is freed, bytes."""

KEPT = 16 << 20
"""Free bytes that an arena keeps for later use."""

ARENAS = 4
"""Number of arenas of all threads together; each keeps free memory of its own."""


def limit() -> None:
    """Limit the free memory that the allocator keeps.

    By default glibc keeps ever larger freed arrays (up to 32 MB) in its arenas, of which it has
    eight per core. After maps of a million segments were rebuilt a few times, half of the memory
    was unused.
    """
    with suppress(OSError, AttributeError):  # another system, or another library
        library = ctypes.CDLL("libc.so.6")
        for parameter, value in (
            (_MMAP_THRESHOLD, LARGE),
            (_TRIM_THRESHOLD, KEPT),
            (_ARENA_MAX, ARENAS),
        ):
            library.mallopt(parameter, value)


def release() -> None:
    """Return free memory inside the arenas to the system."""
    with suppress(OSError, AttributeError):  # another system, or another library
        ctypes.CDLL("libc.so.6").malloc_trim(0)
