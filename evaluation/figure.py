"""Figures: axes side by side in a PNG. This module needs no torch."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@contextmanager
def figure(file: Path, columns: int = 1, size: float = 4.2) -> Iterator[list["Axes"]]:
    """Yield axes side by side; at the end save them as a PNG, and make its folder if needed."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    drawn, axes = plt.subplots(
        1, columns, figsize=(size * columns, size), layout="constrained", squeeze=False
    )
    yield list(axes[0])
    file.parent.mkdir(parents=True, exist_ok=True)
    drawn.savefig(file, dpi=100)
    plt.close(drawn)
