"""What makes a training fast on a processor, and what that processor has."""

import ctypes

import torch

M_TRIM_THRESHOLD, M_MMAP_MAX = -1, -4
"""Of mallopt(3)."""


def has_bfloat16() -> bool:
    """Whether the processor multiplies bfloat16 itself; emulated, it would be slower."""
    return bool(torch.cpu.get_capabilities().get("avx512_bf16", False))


def keep_freed_memory() -> None:
    """Have glibc keep what is freed instead of giving it back to the system.

    Each step frees and takes the same large activations; fresh from the system, every page of them
    is cleared anew, which costs more than the convolutions do.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (OSError, AttributeError):
        return  # another C library
    mallopt(M_MMAP_MAX, 0)
    mallopt(M_TRIM_THRESHOLD, -1)
