"""Network of the shape decoder: logits of occupancy from what a map holds of a segment.

A small perceptron reads the segment's own part of the descriptor, where the sensor was, the box and
the number of points. Its features weight a basis of grids and profiles along the axes. They also
place two surfaces: one across the rows of voxels along x, one across those along y. The box is
known along the map's axes; voxels outside of it are excluded by its turned sides.
"""

import math
from collections.abc import Sequence
from itertools import pairwise

import torch
from torch import Tensor, nn
from torch.nn import functional

from placecell.core.types import Float32

HIDDEN = 512
"""Number of features of the perceptron's layers."""

LAYERS = 3
"""Number of layers of the perceptron."""

BASIS = 36
"""Number of grids in the basis; with 8-bit weights they take 0.9 MB."""

DEPTH, FAR = 4.0, 8.0
"""Unit of a surface's place in a row, and largest distance from it that counts, voxels."""

OUTSIDE = 12.0, 0.4
"""Logit that is subtracted for each meter outside of the box, and largest distance, meters."""

ENTROPY, OCCUPIED = 0.5, 4.0
"""Weight of the cross entropy in the loss, and weight of occupied voxels in the cross entropy."""

EMPTY = -1.5
"""Logit of a voxel before the training."""

FEATURES = 19
"""Number of inputs of the perceptron beside the descriptor."""


NIBBLES, STEPS = 2, 15
"""Number of values in a further byte, and largest number of a value's 4 bits."""


class ExtraEncoder(nn.Module):
    """Encoder of further bytes of a segment from its true grid; the rounding is in the training."""

    def __init__(self, bytes_: int, grid: tuple[int, int, int], given: int) -> None:
        """Create the encoder.

        Args:
            bytes_: number of further bytes.
            grid: number of voxels along x, y, z.
            given: number of values that the decoder has without the further bytes.
        """
        super().__init__()
        self.grid, self.values = grid, NIBBLES * bytes_
        self.padding = [even for size in reversed(grid) for even in (0, size % 2)]
        self.convolutions = nn.Sequential(
            nn.Conv3d(8, 24, 3, stride=2, padding=1),
            nn.ReLU(),
            nn.Conv3d(24, 48, 3, stride=2, padding=1),
            nn.ReLU(),
            nn.Flatten(),
        )
        cells = math.prod(-(-size // 8) for size in grid)
        self.perceptron = nn.Sequential(
            nn.Linear(48 * cells + given, HIDDEN), nn.ReLU(), nn.Linear(HIDDEN, self.values)
        )

    def forward(self, occupied: Tensor, given: Tensor) -> Tensor:
        """Return the rounded values, -1 to 1, float32 (n, values).

        The gradient passes the rounding unchanged (straight-through estimator, Bengio et al.,
        2013).

        Args:
            occupied: all voxels of the true grids, 0 or 1, uint8 (n, voxels).
            given: what the decoder has without the further bytes, float32 (n, given).
        """
        grids = functional.pad(occupied.reshape(-1, *self.grid), self.padding).float()
        count, x, y, z = grids.shape
        # The eight voxels of each cell are channels: nothing is lost, and the layers are small.
        cells = grids.reshape(count, x // 2, 2, y // 2, 2, z // 2, 2).permute(0, 2, 4, 6, 1, 3, 5)
        seen = self.convolutions(cells.reshape(count, 8, x // 2, y // 2, z // 2))
        smooth = torch.tanh(self.perceptron(torch.cat([seen, given], dim=1)).float())
        rounded = torch.round((smooth + 1) * STEPS / 2) * 2 / STEPS - 1
        return smooth + (rounded - smooth).detach()


class Surface(nn.Module):
    """Surface across the rows of voxels along one axis: part of the logits, largest on it.

    In each row, the surface has a place. So a wall at any angle and distance is one map of places,
    where a basis of grids needs a grid for each of them.
    """

    def __init__(self, grid: tuple[int, int, int], axis: int) -> None:
        """Create the surface.

        Args:
            grid: number of voxels along x, y, z.
            axis: axis of the rows, 0 (x) or 1 (y).
        """
        super().__init__()
        self.grid, self.axis = grid, axis
        rows = math.prod(grid) // grid[axis]
        self.place, self.sharpness, self.height = (nn.Linear(HIDDEN, rows) for _ in range(3))
        for layer in (self.place, self.sharpness, self.height):
            nn.init.normal_(layer.weight, std=0.02)
            nn.init.zeros_(layer.bias)

    def forward(self, features: Tensor, voxels: Tensor | None) -> Tensor:
        """Return its part of the logits of some voxels, (n, voxels), or of all, (n, x, y, z)."""
        place, height = self.place(features).float() * DEPTH, self.height(features).float()
        sharpness = functional.softplus(self.sharpness(features).float())
        _, y, z = self.grid
        cells = torch.arange(self.grid[self.axis]) - (self.grid[self.axis] - 1) / 2
        if voxels is None:
            shape = [-1, *self.grid]
            shape[1 + self.axis] = 1
            along = cells.reshape(-1, 1, 1) if self.axis == 0 else cells.reshape(-1, 1)
            place, height, sharpness = (each.reshape(shape) for each in (place, height, sharpness))
        else:
            column, row, layer = voxels // (y * z), voxels // z % y, voxels % z
            across, along = (row, cells[column]) if self.axis == 0 else (column, cells[row])
            place, height, sharpness = (
                each.index_select(1, across * z + layer) for each in (place, height, sharpness)
            )
        return height - sharpness * (along - place).abs().clamp(max=FAR)


class ShapeNetwork(nn.Module):
    """Network of the shape decoder."""

    own: Tensor

    def __init__(
        self,
        own: Float32,
        grid: tuple[int, int, int],
        voxel: float,
        extra: ExtraEncoder | None = None,
    ) -> None:
        """Create the network.

        Args:
            own: projection of a descriptor to the segment's own part, float32 (dimension, own).
            grid: number of voxels along x, y, z.
            voxel: edge length of a voxel, meters.
            extra: encoder of further bytes from the true grid; None: the decoder reads only what a
                map holds.
        """
        super().__init__()
        self.grid, self.voxel, self.extra = grid, voxel, extra
        self.register_buffer("own", torch.from_numpy(own))
        further = 0 if extra is None else extra.values
        widths = [own.shape[1] + FEATURES + further, *[HIDDEN] * LAYERS]
        layers: list[nn.Module] = []
        for before, after in pairwise(widths):
            layers += [nn.Linear(before, after), nn.ReLU()]
        self.perceptron = nn.Sequential(*layers)
        self.center = nn.Linear(HIDDEN, 3)
        self.box = nn.Linear(HIDDEN, 3)
        nn.init.zeros_(self.box.weight)
        nn.init.zeros_(self.box.bias)
        self.weights = nn.Linear(HIDDEN, BASIS)
        self.basis = nn.Linear(BASIS, math.prod(grid))
        nn.init.normal_(self.basis.weight, std=0.02)
        nn.init.constant_(self.basis.bias, EMPTY)
        self.profiles = nn.ModuleList(nn.Linear(HIDDEN, size) for size in grid)
        self.surfaces = nn.ModuleList(Surface(grid, axis) for axis in (0, 1))

    def forward(
        self, descriptor: Tensor, offset: Tensor, bearing: Tensor, extents: Tensor, points: Tensor
    ) -> tuple[Tensor, Tensor]:
        """Return logits, float32 (n, x, y, z), and the grid's center, float32 (n, 3).

        Args:
            descriptor: decoded descriptors, float32 (n, dimension).
            offset: horizontal distance from the sensor to the centroid, and height of the centroid
                above the sensor, float32 (n, 2), meters.
            bearing: bearing of the sensor from the centroid, float32 (n,), radians.
            extents: box along the map's axes, float32 (n, 3), meters; three zeros: unknown.
            points: number of points, float32 (n,); 0: unknown.
        """
        given = descriptor, offset, bearing, extents, points
        return self.at(None, *given)

    def at(
        self,
        voxels: Tensor | None,
        descriptor: Tensor,
        offset: Tensor,
        bearing: Tensor,
        extents: Tensor,
        points: Tensor,
        *,
        occupied: Tensor | None = None,
    ) -> tuple[Tensor, Tensor]:
        """Return logits of some voxels, float32 (n, voxels), and the centers; see `forward`.

        Args:
            voxels: indices of voxels, int64 (voxels,); None: all, as (n, x, y, z).
            descriptor, offset, bearing, extents, points: see `forward`.
            occupied: all voxels of the true grids, 0 or 1, uint8 (n, voxels), for the encoder of
                further bytes; other networks do not read it.
        """
        cosine, sine = torch.cos(bearing)[:, None], torch.sin(bearing)[:, None]
        known = (extents.sum(dim=1, keepdim=True) > 0).float()
        given = torch.cat(
            [
                functional.normalize(descriptor @ self.own, dim=1) * self.own.shape[1] ** 0.5,
                *inputs(offset, cosine, sine, extents, known, points),
            ],
            dim=1,
        )
        if self.extra is not None:
            assert occupied is not None
            given = torch.cat([given, self.extra(occupied, given)], dim=1)
        features = self.perceptron(given)
        weight: Tensor = self.basis.weight
        bias: Tensor = self.basis.bias
        if voxels is not None:
            weight, bias = weight.index_select(0, voxels), bias[voxels]
        logits = functional.linear(self.weights(features), weight, bias)
        if voxels is None:
            logits = logits.reshape(-1, *self.grid)
        for axis, profile in enumerate(self.profiles):
            logits = logits + self._along(axis, profile(features), voxels)
        surfaces = (surface(features, voxels) for surface in self.surfaces)
        logits = logits.float() + torch.logaddexp(*surfaces)
        places = [
            self._along(axis, ((torch.arange(size) - (size - 1) / 2) * self.voxel)[None], voxels)
            for axis, size in enumerate(self.grid)
        ]
        ones = (1,) * (logits.dim() - 1)
        sides = [each.reshape(-1, *ones) for each in (cosine, sine, *extents.T)]
        shifts = [each.reshape(-1, *ones) for each in self.box(features).T]
        beyond = outside(places, sides, shifts, self.voxel / 2)
        rate, most = OUTSIDE
        logits = logits - rate * beyond.clamp(max=most) * known.reshape(-1, *ones)
        return logits, self.center(features).float()

    def _along(self, axis: int, values: Tensor, voxels: Tensor | None) -> Tensor:
        """Return values along an axis of the grid, (n, size), at voxels, to be broadcast."""
        if voxels is None:
            shape = [1, 1, 1]
            shape[axis] = self.grid[axis]
            return values.reshape(-1, *shape)
        return values[:, voxels // math.prod(self.grid[axis + 1 :]) % self.grid[axis]]


def inputs(
    offset: Tensor, cosine: Tensor, sine: Tensor, extents: Tensor, known: Tensor, points: Tensor
) -> list[Tensor]:
    """Return the inputs of the perceptron beside the descriptor, all about -2 to 2.

    The box along the map's axes does not change when both turn by half a turn. So it is read with
    twice the bearing, and as the box around it along the axes of the grid.
    """
    double = torch.cat([cosine**2 - sine**2, 2 * sine * cosine], dim=1)
    fourfold = torch.cat(
        [double[:, :1] ** 2 - double[:, 1:] ** 2, 2 * double[:, :1] * double[:, 1:]], dim=1
    )
    lengths = torch.log(extents.clamp(min=0.1))
    longer = lengths[:, :1] - lengths[:, 1:2]
    along = extents[:, :1] * cosine.abs() + extents[:, 1:2] * sine.abs()
    across = extents[:, :1] * sine.abs() + extents[:, 1:2] * cosine.abs()
    counted = (points[:, None] > 0).float()
    return [
        torch.log(offset[:, :1].clamp(min=0.5)) - 2,
        offset[:, 1:] / 2,
        known,
        torch.cat([lengths, extents / 4, double, fourfold, longer * double], dim=1) * known,
        torch.cat([along, across], dim=1) / 4 * known,
        counted,
        (torch.log(points[:, None].clamp(min=1)) - 5) / 2 * counted,
    ]


def outside(
    places: Sequence[Tensor], sides: Sequence[Tensor], shifts: Sequence[Tensor], margin: float
) -> Tensor:
    """Return how far each voxel's center is outside of the box, float32, meters.

    All tensors are broadcast: segments along the first dimension, voxels along the others.

    Args:
        places: x, y and z of the voxels' centers relative to the grid's center, meters.
        sides: cosine and sine of the bearing, and the box along the map's axes, meters.
        shifts: horizontal shift of the box's center, meters, and change of the margin, margins.
        margin: half a voxel, meters: a voxel is occupied if the box touches it.
    """
    x, y, z = places
    cosine, sine, length, width, height = sides
    shift_x, shift_y, wider = shifts
    east = (x * cosine - y * sine - shift_x).abs() - length / 2
    north = (x * sine + y * cosine - shift_y).abs() - width / 2
    horizontal = torch.maximum(east, north) - margin * (1 + wider)
    vertical = z.abs() - height / 2 - margin
    return functional.relu(torch.maximum(horizontal, vertical))


def shape_loss(
    logits: Tensor,
    occupied: Tensor,
    entropy_weight: float = ENTROPY,
    weights: Tensor | None = None,
) -> tuple[Tensor, Tensor]:
    """Return the loss of logits, and the mean soft intersection over union.

    The loss is one minus the soft intersection over union (Rahman and Wang, 2016), which is what
    counts, and the cross entropy, which has a gradient from the first step on.

    Args:
        logits: float32 (n, voxels).
        occupied: 0 or 1, float32 (n, voxels).
        entropy_weight: weight of the cross entropy.
        weights: weight of each voxel, float32 (voxels,); None: one.
    """
    if weights is None:
        weights = torch.ones(logits.shape[1])
    likely = torch.sigmoid(logits)
    common = (likely * occupied) @ weights
    union = likely @ weights + occupied @ weights - common
    overlap = (common / (union + 1)).mean()
    entropy = functional.binary_cross_entropy_with_logits(
        logits, occupied, pos_weight=torch.tensor(OCCUPIED), reduction="none"
    )
    return 1 - overlap + entropy_weight * (entropy @ weights).mean() / weights.sum(), overlap
