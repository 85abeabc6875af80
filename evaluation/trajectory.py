"""Errors of a trajectory: absolute (ATE) and relative (RPE), as in the field's benchmarks.

Sources: Sturm et al. 2012, *A benchmark for the evaluation of RGB-D SLAM systems*; Umeyama 1991 for
the alignment, without a scale. The test compares both with the program evo.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from placecell.localization.registration import register_se3


@dataclass(frozen=True, slots=True)
class TrajectoryError:
    """Errors of n poses.

    Attributes:
        rmse: root mean square.
        mean: mean.
        median: median.
        largest: largest.
    """

    rmse: float
    mean: float
    median: float
    largest: float

    @classmethod
    def of(cls, errors: Float64) -> "TrajectoryError":
        """Summarize errors (n,); zeros without any."""
        if not len(errors):
            return cls(0.0, 0.0, 0.0, 0.0)
        return cls(
            float(np.sqrt(np.mean(errors**2))),
            float(errors.mean()),
            float(np.median(errors)),
            float(errors.max()),
        )


def absolute_error(
    estimated: Float64, true: Float64, align: bool = True, scale: bool = False
) -> TrajectoryError:
    """Return the absolute trajectory error: the distances of positions after the best alignment.

    Args:
        estimated: float64 (n, 3), meters, estimated positions.
        true: float64 (n, 3), meters, true positions at the same moments.
        align: move the whole estimate rigidly onto the truth first.
        scale: then also scale it about its center, which shows the error without that of the scale.

    Raises:
        ValueError: The two have different shapes.
    """
    if estimated.shape != true.shape:
        raise ValueError(
            f"Invalid trajectories of {estimated.shape} and {true.shape}: expected equal shapes."
        )
    if align and len(estimated):
        pose = register_se3(estimated, true, np.ones(len(estimated)))
        estimated = pose.apply(estimated)
    if scale and len(estimated):
        middle = estimated.mean(axis=0)
        offsets, wanted = estimated - middle, true - true.mean(axis=0)
        estimated = true.mean(axis=0) + offsets * (offsets * wanted).sum() / (offsets**2).sum()
    return TrajectoryError.of(np.linalg.norm(estimated - true, axis=1))


def relative_error(
    estimated: Float64, true: Float64, step: int = 1
) -> tuple[TrajectoryError, TrajectoryError]:
    """Return the relative pose error over a number of poses: meters, and degrees.

    Args:
        estimated: float64 (n, 4, 4), estimated poses.
        true: float64 (n, 4, 4), true poses at the same moments.
        step: number of poses from the begin of a pair to its end; pairs do not overlap.

    Raises:
        ValueError: The two have different shapes, or the step is not positive.
    """
    if estimated.shape != true.shape or step < 1:
        raise ValueError(
            f"Invalid trajectories of {estimated.shape} and {true.shape}, step {step}: expected "
            "equal shapes and a step of 1 or more."
        )
    begins = np.arange(0, len(true) - step, step)
    moved, expected = (
        np.linalg.inv(poses[begins]) @ poses[begins + step] for poses in (estimated, true)
    )
    off = np.linalg.inv(expected) @ moved
    cosines = (np.trace(off[:, :3, :3], axis1=1, axis2=2) - 1) / 2
    angles = np.degrees(np.arccos(cosines.clip(-1, 1)))
    meters = np.linalg.norm(off[:, :3, 3], axis=1)
    return TrajectoryError.of(meters), TrajectoryError.of(angles)
