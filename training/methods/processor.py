"""Processor settings for fast trainings: memory allocation and bfloat16 support."""

import ctypes

import torch

M_TRIM_THRESHOLD, M_MMAP_MAX = -1, -4
"""Parameters of mallopt(3)."""


def has_bfloat16() -> bool:
    """Return whether the processor supports bfloat16; emulation would be slower."""
    return bool(torch.cpu.get_capabilities().get("avx512_bf16", False))


def keep_freed_memory() -> None:
    """Make glibc keep freed memory instead of returning it to the system.

    Each step frees and allocates the same large activations. The system clears every new page,
    which takes longer than the convolutions.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (OSError, AttributeError):
        return  # another C library
    mallopt(M_MMAP_MAX, 0)
    mallopt(M_TRIM_THRESHOLD, -1)
