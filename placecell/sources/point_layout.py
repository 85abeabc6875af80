"""Layout of scan files without a header: number, type and order of columns.

A `.bin` file does not say what it holds. KITTI's has float32 x, y, z, reflectance; nuScenes' has
five columns, Waymo's six, others three, or float64. Read with the wrong layout, all of them give
points, and every figure that follows is wrong. So the layout is found from several scans: in the
right one each column holds one quantity, and its values are alike. The measure is the number of
bits that a value needs if the histogram of its column is known (minimum description length).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float32, Float64, Int64
from placecell.sources.errors import DriveError
from placecell.sources.point_times import is_time
from placecell.sources.scan_options import METERS, DType, Order, ScanOptions

SAMPLED_SCANS = 8
STRETCHES = 8
STRETCH = 7_560
"""Values of a sample, a common multiple of all column counts: it begins a row in every layout."""
COLUMN_COUNTS = (3, 4, 5, 6, 7, 8, 9, 10)
BINS = 64
FEWEST_POINTS = 100
"""Smallest number of points of a scan whose content is judged; smaller scans of a standing sensor
repeat themselves."""
CONTRADICTED = 1.0
"""Bits per value by which small scans must fit KITTI's layout worse to be refused."""
MARGIN = 0.2
"""Bits per value by which a layout must be better than all others; measured: 0.5 or more."""
TINY, HUGE = 1e-5, 1e6
"""Smallest and largest plausible magnitude of sensor values; others are misread bits."""
FARTHEST_MEDIAN = 250.0
"""Largest plausible median range, meters; a LiDAR scan's is some 10 m."""

SWEEPS = (0.01, 0.5)
"""Shortest and longest duration of a sweep that is told by the values of a column, seconds."""
ASCENDING, DIFFERENT = 0.97, 0.01
"""Smallest share of points that are no earlier, and that are later, than the point before."""

ITEM_SIZES: dict[DType, int] = {"float32": 4, "float64": 8}
TYPES: dict[DType, str] = {"float32": "<f4", "float64": "<f8"}
NAMES = ("x", "y", "z", "reflectance")
STATE_IT = (
    "State the layout with --columns (their number, or names such as x,y,z,intensity,ring), "
    "--dtype float64 and --order columns"
)


@dataclass(frozen=True, slots=True)
class PointLayout:
    """Layout of a scan file.

    Attributes:
        columns: names of the columns, x, y and z among them.
        dtype: type of the values, little-endian.
        order: whether rows or whole columns follow each other.
        scale: meters a unit.
    """

    columns: tuple[str, ...] = NAMES
    dtype: DType = "float32"
    order: Order = "rows"
    scale: float = 1.0

    @property
    def point_bytes(self) -> int:
        """Return the bytes of one point."""
        return len(self.columns) * ITEM_SIZES[self.dtype]

    def __str__(self) -> str:
        order = "" if self.order == "rows" else ", column after column"
        return f"{len(self.columns)} columns of {self.dtype} ({', '.join(self.columns)}{order})"

    def read(self, file: Path) -> Float32:
        """Read a scan: float32 (n, 3), meters, sensor frame; values may be NaN or infinite.

        Raises:
            DriveError: missing, unreadable, empty or cut short.
        """
        table = self.read_table(file)
        axes = [self.columns.index(axis) for axis in "xyz"]
        points = np.ascontiguousarray(table[:, axes])
        if self.scale != 1.0:
            points = points * self.scale
        with np.errstate(over="ignore"):  # float64 beyond float32 becomes infinite, and is dropped
            return points.astype(np.float32, copy=False)

    @property
    def time_column(self) -> int | None:
        """Index of the column with the times of the points; None if there is none."""
        return next((at for at, name in enumerate(self.columns) if is_time(name)), None)

    def read_table(self, file: Path) -> NDArray[np.floating]:
        """Read all values of a scan, (points, columns).

        Raises:
            DriveError: missing, unreadable, empty or cut short.
        """
        try:
            content = file.read_bytes()
        except OSError as error:
            raise DriveError(f"{file}: cannot be read ({error.strerror})") from error
        if not content:
            raise DriveError(f"{file}: holds no points (0 bytes)")
        if len(content) % self.point_bytes:
            raise DriveError(
                f"{file}: {len(content)} bytes is no whole number of points "
                f"({self.point_bytes} bytes each: {self}); the file is cut short or of another kind"
            )
        return self.as_table(np.frombuffer(content, TYPES[self.dtype]))

    def as_table(self, values: NDArray[np.floating]) -> NDArray[np.floating]:
        """Arrange a file's values as (points, columns)."""
        count = len(self.columns)
        return values.reshape(-1, count) if self.order == "rows" else values.reshape(count, -1).T


KITTI = PointLayout()


def stated_layout(options: ScanOptions) -> PointLayout:
    """Return the layout that the options state; what they leave open follows KITTI."""
    return PointLayout(
        columns=options.columns or NAMES,
        dtype=options.dtype or "float32",
        order=options.order,
        scale=METERS[options.unit],
    )


def find_layout(files: Sequence[Path], sizes: Sequence[int], options: ScanOptions) -> PointLayout:
    """Find the layout of a drive's scans.

    KITTI's own layout is kept unless the content contradicts it.

    Args:
        sizes: of the files, bytes; -1 where a file cannot be read.

    Raises:
        DriveError: the content contradicts the layout that was given, or every layout.
    """
    whole = np.array([size for size in sizes if size > 0])
    sampled = sample(files, sizes)
    if not len(whole) or not sampled:
        return stated_layout(options)
    folder = files[0].parent if len(files) > 1 else files[0]
    if options.states_layout:
        layout = stated_layout(options)
        if divisible(whole, layout.point_bytes) < 0.5:
            raise DriveError(
                f"{folder}: {count_of(whole, layout.point_bytes)} have no whole number of points "
                f"of {layout}; the stated layout does not fit"
            )
    else:
        layout = layout_from_content(folder, whole, sampled, METERS[options.unit])
    check_unit(folder, layout, sampled)
    return layout


def sample(files: Sequence[Path], sizes: Sequence[int]) -> list[bytes]:
    """Read some scans, evenly spread over the drive."""
    usable = [file for file, size in zip(files, sizes, strict=True) if size > 0]
    if not usable:
        return []
    chosen = np.unique(np.linspace(0, len(usable) - 1, SAMPLED_SCANS).astype(int))
    contents = []
    for index in chosen:
        try:
            contents.append(usable[index].read_bytes())
        except OSError:
            continue
    return list(dict.fromkeys(contents))  # A scan that is repeated says nothing new.


def divisible(sizes: NDArray[np.int_], point_bytes: int) -> float:
    """Return the share of files that hold a whole number of points."""
    return float(np.mean(sizes % point_bytes == 0))


def count_of(sizes: NDArray[np.int_], point_bytes: int) -> str:
    """Return how many files hold no whole number of points, with the size of one, as text."""
    bad = sizes[sizes % point_bytes != 0]
    return f"{len(bad)} of {len(sizes)} scans (one of {bad[0]} bytes)"


def layout_from_content(
    folder: Path, sizes: NDArray[np.int_], sampled: Sequence[bytes], scale: float
) -> PointLayout:
    """Find the layout from file sizes and values.

    Raises:
        DriveError: KITTI's layout is contradicted and no other is sure.
    """
    dtype = dtype_of(sampled)
    found = f"{folder}: the scans are not float32 x, y, z, reflectance"
    if dtype is None:
        raise DriveError(
            f"{found}: most values are not coordinates as float32 or float64 (text, integers, "
            "big-endian or compressed data?). Convert them to little-endian float32"
        )
    values = [as_values(content, dtype) for content in sampled]
    if not any(map(len, values)):
        raise DriveError(f"{found}: the longest has {max(map(len, sampled))} bytes, not one value")
    fits = {
        count: divisible(sizes, count * ITEM_SIZES[dtype])
        for count in COLUMN_COUNTS
        if divisible(sizes, count * ITEM_SIZES[dtype]) > 0.5
    }
    bits, pooled = bits_by_columns(values)
    best = fewest_bits(bits, values, fits)
    fits_kitti = dtype == "float32" and len(NAMES) in fits
    points = int(np.median([len(each) for each in values])) // len(NAMES)
    if points < FEWEST_POINTS:
        if fits_kitti and (best is None or bits[len(NAMES)] - bits[best] < CONTRADICTED):
            return PointLayout(scale=scale)
        raise DriveError(
            f"{found}: {fitting_columns(sizes, fits, dtype)}, and {points} points per scan are too "
            f"few to infer the layout from values. {STATE_IT}"
        )
    if best is None or pooled - bits[best] < MARGIN:
        if is_column_major(values, pooled):
            raise DriveError(
                f"{found}: the values of one column follow each other, column after column; "
                f"{fitting_columns(sizes, fits, dtype)}. State it with --order columns --columns N"
            )
        if fits_kitti:
            return PointLayout(scale=scale)  # Nothing speaks for another layout.
        raise DriveError(f"{found}: {fitting_columns(sizes, fits, dtype)}. {STATE_IT}")
    if fits_kitti and bits[len(NAMES)] - bits[best] < MARGIN:
        best = len(NAMES)
    told = f"by their values they have {best} columns of {dtype}"
    if best != len(NAMES) or dtype != "float32":
        rest = [each for count, each in bits.items() if count % best]
        if rest and min(rest) - bits[best] < MARGIN:
            raise DriveError(f"{found}; {told}, which is not sure. {STATE_IT}")
    if wrong := axes_problem(values, best):
        raise DriveError(f"{found}: {told}, but {wrong}. {STATE_IT}")
    names = {3: NAMES[:3], 4: NAMES}.get(best) or names_of(sampled, best, dtype)
    return PointLayout(columns=names, dtype=dtype, scale=scale)


def names_of(sampled: Sequence[bytes], count: int, dtype: DType) -> tuple[str, ...]:
    """Return names for columns whose number is found: a column with the points' times is told.

    Points are stored as the sensor measured them, all of them or beam after beam. So the times
    ascend almost everywhere, and they span one sweep.
    """
    names = ["x", "y", "z", *(f"column_{number}" for number in range(3, count))]
    tables = [
        np.frombuffer(content, TYPES[dtype])[: len(content) // ITEM_SIZES[dtype] // count * count]
        for content in sampled
    ]
    for column in range(3, count):
        values = [table.reshape(-1, count)[:, column].astype(np.float64) for table in tables]
        if all(is_sweep(each) for each in values):
            names[column] = "time"
            break
    return tuple(names)


def is_sweep(values: Float64) -> bool:
    """Return whether values are the times of the points of one sweep, seconds."""
    if len(values) < FEWEST_POINTS or not np.isfinite(values).all():
        return False
    span = float(values.max() - values.min())
    steps = np.diff(values)
    ascending = np.mean(steps >= 0) >= ASCENDING and np.mean(steps > 0) >= DIFFERENT
    return bool(SWEEPS[0] <= span <= SWEEPS[1] and np.abs(values).max() <= 1.0 and ascending)


def fitting_columns(sizes: NDArray[np.int_], fits: dict[int, float], dtype: DType) -> str:
    """Return which numbers of columns the sizes of all files allow, as text."""
    if not fits:
        return f"their sizes (one is {sizes[0]} bytes) fit no 3 to 10 columns of {dtype}"
    return (
        f"their sizes (one is {sizes[0]} bytes) fit {', '.join(map(str, fits))} columns of {dtype}"
    )


def as_values(content: bytes, dtype: DType) -> Float64:
    """Return a scan's values, of long scans several stretches of whole rows; NaN becomes 0."""
    item = ITEM_SIZES[dtype]
    values = np.frombuffer(content, TYPES[dtype], len(content) // item)
    if len(values) > STRETCHES * STRETCH:
        starts = np.linspace(0, len(values) // STRETCH - 1, STRETCHES).astype(int) * STRETCH
        values = np.concatenate([values[start : start + STRETCH] for start in starts])
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(values.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)


def implausible(values: NDArray[np.floating]) -> float:
    """Return the share of finite values that no sensor gives: bits read as the wrong type."""
    with np.errstate(invalid="ignore"):
        size = np.abs(values[np.isfinite(values)].astype(np.float64))
    if not len(size):
        return 0.0
    return float(np.mean((size != 0) & ((size < TINY) | (size > HUGE))))


def dtype_of(sampled: Sequence[bytes]) -> DType | None:
    """Distinguish float32 from float64; None if the values are neither.

    The first half of a float64 holds the last bits of its fraction: as a float32 it is noise.
    Columns of other magnitudes, such as a time of 1e15, are few among plausible ones.
    """
    verdicts: list[DType | None] = []
    for content in sampled:
        words = np.frombuffer(content, "<u4", len(content) // 8 * 2)
        singles = np.frombuffer(content, "<f4", len(content) // 4)
        doubles = np.frombuffer(content, "<f8", len(content) // 8)
        if (
            len(words)
            and low_halves(words[0::2]) > 0.7
            and low_halves(words[1::2]) < 0.5
            and implausible(doubles) < 0.35
        ):
            verdicts.append("float64")
        else:
            verdicts.append("float32" if implausible(singles) < 0.4 else None)
    return max(("float32", "float64", None), key=verdicts.count)


def low_halves(words: NDArray[np.uint32]) -> float:
    """Return the share of words that look like a float64's lower half: noise or zero."""
    with np.errstate(invalid="ignore"):
        size = np.abs(np.nan_to_num(words.view("<f4").astype(np.float64), nan=1.0))
    return float(np.mean((words & 0x1FFF_FFFF == 0) | (size < TINY) | (size > HUGE)))


def bits_by_columns(values: Sequence[Float64]) -> tuple[dict[int, float], float]:
    """Return the bits per value for each number of columns, and without columns."""
    numbers = numbered(values)
    return {count: bits_of(columns_of(numbers, count)) for count in COLUMN_COUNTS}, bits_of(
        [np.concatenate(numbers)]
    )


def numbered(values: Sequence[Float64]) -> list[Int64]:
    """Return each value's histogram bin; bins hold equal counts as far as values differ."""
    pooled = np.concatenate(values)
    bins = int(np.clip(len(pooled) // 40, 8, BINS))
    some = pooled[:: max(1, len(pooled) // 50_000)]
    edges = np.unique(np.quantile(some, np.linspace(0, 1, bins + 1)[1:-1]))
    return [np.searchsorted(edges, each, side="right") for each in values]


def columns_of(numbers: Sequence[Int64], count: int) -> list[Int64]:
    """Return the bins of each of `count` columns, over all scans."""
    tables = [each[: len(each) // count * count].reshape(-1, count) for each in numbers]
    return list(np.concatenate(tables).T)


def bits_of(columns: Sequence[Int64]) -> float:
    """Return the bits per value, including the cost of the columns' histograms."""
    total, values = 0.0, 0
    for column in columns:
        if not len(column):
            continue
        counts = np.bincount(column)
        used = counts[counts > 0]
        total -= float((used * np.log2(used / len(column))).sum())
        total += (len(used) - 1) / 2 * np.log2(max(len(column), 2))
        values += len(column)
    return total / max(values, 1)


def fewest_bits(
    bits: dict[int, float], values: Sequence[Float64], fits: dict[int, float]
) -> int | None:
    """Return the number of columns that explains the values best and fits the file sizes.

    A multiple explains them as well. Where lasers fire in turn it may do so even better; so the
    smaller number is taken if its columns are alike in both halves of the larger one.
    """
    able = [count for count in bits if count in fits]
    if not able:
        return None
    best = min(able, key=bits.__getitem__)
    numbers = numbered(values)
    for count in able:
        if count < best and best % count == 0:
            columns = columns_of(numbers, best)
            apart = max(distance(columns[axis], columns[axis + count]) for axis in (0, 1))
            if bits[count] - bits[best] < 0.05 or apart < 0.3:
                return count
    return best


def distance(one: Int64, other: Int64) -> float:
    """Return the total variation distance between two columns' histograms, 0 to 1."""
    size = BINS + 1
    shares = [np.bincount(each, minlength=size) / max(len(each), 1) for each in (one, other)]
    return float(np.abs(shares[0] - shares[1]).sum() / 2)


def is_column_major(values: Sequence[Float64], pooled: float) -> bool:
    """Return whether a file stores column after column: values alike, but no row length fits."""
    numbers = numbered(values)
    stretches: list[list[Int64]] = [[] for _ in range(STRETCHES)]
    for each in numbers:
        for index, stretch in enumerate(np.array_split(each, STRETCHES)):
            stretches[index].append(stretch)
    return pooled - bits_of([np.concatenate(some) for some in stretches]) > 2 * MARGIN


def axes_problem(values: Sequence[Float64], count: int) -> str:
    """Return why the first three columns may not be x, y and z; empty if they may be."""
    table = np.concatenate(
        [each[: len(each) // count * count].reshape(-1, count) for each in values]
    )
    table = table[np.any(table[:, :3] != 0, axis=1)]
    if len(table) < FEWEST_POINTS:
        return ""
    spans = np.quantile(table, 0.95, axis=0) - np.quantile(table, 0.05, axis=0)
    later = table[:, 3:]
    # Coordinates are of both signs and no whole numbers.
    signed = np.any(later < 0, axis=0) & np.any(later != np.round(later), axis=0)
    for axis in (0, 1):
        column = table[:, axis]
        if column.min() < 0:
            continue
        whole = np.mean(column == np.round(column)) > 0.95 and len(np.unique(column)) <= 300
        if whole and signed.any():
            return (
                f"column {axis + 1} holds whole numbers, such as rings, so it is not {'xyz'[axis]}"
            )
        if column.max() <= 1 and np.any(signed & (spans[3:] > 3 * max(spans[axis], 0.1))):
            return f"column {axis + 1} holds values from 0 to 1, so it is not {'xyz'[axis]}"
    return ""


def check_unit(folder: Path, layout: PointLayout, sampled: Sequence[bytes]) -> None:
    """Refuse coordinates that are not meters in the sensor's frame.

    Raises:
        DriveError: the median range is beyond any LiDAR's, or the points lie far from the sensor.
    """
    ranges, centers = [], []
    item = len(layout.columns) * ITEM_SIZES[layout.dtype]
    for content in sampled:
        if len(content) % item and layout.order == "columns":
            continue
        values = np.frombuffer(content[: len(content) // item * item], TYPES[layout.dtype])
        table = layout.as_table(values)
        axes = [layout.columns.index(axis) for axis in "xyz"]
        with np.errstate(invalid="ignore", over="ignore"):  # damaged values may be enormous
            points = table[:, axes].astype(np.float64) * layout.scale
            points = points[np.isfinite(points).all(axis=1) & np.any(points != 0, axis=1)]
            if len(points):
                ranges.append(np.median(np.linalg.norm(points, axis=1)))
                centers.append(np.linalg.norm(np.median(points, axis=0)))
    if not ranges or np.median(ranges) <= FARTHEST_MEDIAN:
        return
    far = float(np.median(ranges))
    if np.median(centers) > 0.8 * far:
        raise DriveError(
            f"{folder}: the points lie {far:,.0f} m from the sensor (median): they are in a map's "
            "frame, or not in meters. Scans must be in the sensor's frame; state another unit "
            "with --unit mm or --unit cm"
        )
    raise DriveError(
        f"{folder}: the median range is {far:,.0f} m, beyond any LiDAR: the scans are not in "
        f"meters ({'millimeters' if far > 2_000 else 'centimeters or millimeters'}?). State the "
        "unit with --unit mm or --unit cm; or the columns with --columns"
    )
