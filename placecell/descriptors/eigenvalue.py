"""Eigenvalue descriptor of SegMatch, the paper's baseline.

Source: Weinmann et al. 2014, *Semantic 3D scene interpretation*, section 4. Eigenvalues are sorted
in descending order, l1 >= l2 >= l3. (Earlier systems sorted them in ascending order and omitted the
minus sign of the entropy.)
"""

import numpy as np

from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64

FEATURES = (
    "linearity",
    "planarity",
    "scattering",
    "omnivariance",
    "anisotropy",
    "eigenentropy",
    "change of curvature",
)


def eigenvalues(segments: Segments) -> Float64:
    """Return the variances along the principal axes, m^2, descending, float64 (segments, 3)."""
    if not len(segments):
        return np.zeros((0, 3))
    centered = segments.points - np.repeat(segments.centroids(), segments.counts, axis=0)
    products = centered[:, :, None] * centered[:, None, :]
    covariance = np.add.reduceat(products, segments.starts, axis=0) / segments.counts[:, None, None]
    return np.asarray(np.linalg.eigvalsh(covariance)[:, ::-1].clip(min=0.0))


def eigenvalue_features(values: Float64) -> Float64:
    """Return the seven features, float64 (n, 7), of eigenvalues l1 >= l2 >= l3, float64 (n, 3).

    Omnivariance and eigenentropy use eigenvalues that are normalized to a sum of 1. A segment whose
    points coincide (l1 = 0) has features 0.
    """
    largest = np.where(values[:, :1] > 0, values[:, :1], 1.0)
    total = np.where(values[:, :1] > 0, values.sum(axis=1, keepdims=True), 1.0)
    l1, l2, l3 = (values / largest).T
    share = values / total
    # x log x -> 0 as x -> 0.
    entropy = -(share * np.log(np.where(share > 0, share, 1.0))).sum(axis=1)
    return np.stack(
        [l1 - l2, l2 - l3, l3, np.cbrt(share.prod(axis=1)), l1 - l3, entropy, share[:, 2]], axis=1
    )


def eigenvalue_descriptors(segments: Segments) -> Float32:
    """Return the seven features of each segment, not standardized, float32 (segments, 7)."""
    return eigenvalue_features(eigenvalues(segments)).astype(np.float32)
