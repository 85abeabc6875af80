"""Index: exact nearest descriptors in maps of any size.

Two dimensions of two bits fill a nibble, as does one of four: that is a product quantizer whose
codebook needs no training. FAISS scans such codes 32 at a time in registers (André et al., *Cache
locality is not enough*, VLDB 2015). FAISS rounds the distances, by at most a known bound. The index
computes exact distances of the rows that FAISS returns. If a missing row could be nearer within the
bound, the index asks FAISS for more rows.
"""

from abc import ABC, abstractmethod
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from threading import Lock
from typing import Any

import faiss
import numpy as np

from placecell.core.processors import available_cores
from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Bool, Float32, Float64, Int8, Int64, UInt8, UInt16
from placecell.descriptors.quantizer import LEVELS, Quantizer
from service.maps.layers import MapLayers, classes_of

MARGIN = 24
"""Number of rows fetched beyond k at first, so that few queries need a second search."""

MOST = 1 << 10
"""Largest number of rows fetched to resolve ties; the index drops some of more equal rows."""

ROWS = 1 << 14
"""Number of codes converted to levels per step; as floats they take 4 to 16 times the bytes."""

PARALLEL = 1 << 23
"""Number of compared pairs of query and row from which a search uses all cores: some 10 ms."""

BLOCK = 1 << 21
"""Bytes of codes compared per step; many ties would otherwise take gigabytes."""

SCAN = 15
"""How FAISS scans (its `implem`): every block of codes is compared with all queries in turn. From
four queries on, this takes three quarters of the time of FAISS's own choice, and never more."""

FILTERS = 2
"""Largest number of filters of an index whose rows are kept as indexes of their own; each takes up
to the memory of the index."""

CORES = available_cores()

_threads = ThreadPoolExecutor(CORES, thread_name_prefix="index")
"""Threads of all large searches together, one per core."""


class MapIndex(ABC):
    """Index over stored descriptors by Euclidean distance."""

    def __init__(self, codes: Int8, quantizer: Quantizer) -> None:
        """Index codes, int8 (n, code bytes)."""
        self._codes = codes
        self._quantizer = quantizer
        self._parts: OrderedDict[ClassFilter, FilteredIndex] = OrderedDict()
        self._parts_lock = Lock()

    def filtered(self, classes: UInt8, wanted: ClassFilter) -> "FilteredIndex":
        """Return the index over the rows that a filter keeps; the last few are kept in memory.

        Args:
            classes: class of each row, uint8 (n,), always the same.
            wanted: the filter.
        """
        with self._parts_lock:
            part = self._parts.get(wanted)
            if part is None:
                rows = np.flatnonzero(wanted.keeps(classes))
                whole = len(rows) == len(self)
                codes = self._codes if whole else self._codes[rows]
                part = FilteredIndex(rows, self if whole else index_of(codes, self._quantizer))
                self._parts[wanted] = part
            self._parts.move_to_end(wanted)
            while len(self._parts) > FILTERS:
                self._parts.popitem(last=False)
            return part

    def __len__(self) -> int:
        return len(self._codes)

    def search(
        self, codes: Int8, k: int, gone: Bool | None = None, margin: int = MARGIN
    ) -> tuple[Float64, Int64]:
        """Return the k nearest rows to each query, independent of the other queries.

        Args:
            codes: queries, int8 (q, code bytes).
            k: number of rows; all rows if there are fewer.
            gone: rows to exclude, bool (n,); None: none.
            margin: number of rows to fetch beyond k.

        Returns:
            Distances in steps of the quantizer, float64 (q, min(k, n)), ascending; and rows,
            int64, of the same shape, ascending among equal distances.
        """
        k = min(k, len(self) - (0 if gone is None else int(np.count_nonzero(gone))))
        if not k or not len(codes):
            return np.zeros((len(codes), k)), np.zeros((len(codes), k), dtype=np.int64)
        fetch = min(k + margin, len(self))
        squared, rows, complete = self._scan(codes, fetch)
        if gone is not None:
            squared[gone[rows]] = np.inf
        order = np.lexsort((rows, squared), axis=1)[:, :k]
        squared = np.take_along_axis(squared, order, axis=1)
        distances, found = np.sqrt(squared), np.take_along_axis(rows, order, axis=1)
        if fetch < len(self):
            farthest = squared[:, -1]
            doubt = ~(farthest < complete) if fetch < MOST else np.isinf(farthest)
            again = np.flatnonzero(doubt)
            if len(again):
                # Many ties mostly come from equal codes.
                distinct, at = np.unique(codes[again], axis=0, return_inverse=True)
                farther, rows = self.search(distinct, k, gone, 4 * margin)
                distances[again], found[again] = farther[at.ravel()], rows[at.ravel()]
        return distances, found

    def _scan(self, codes: Int8, fetch: int) -> tuple[Float64, Int64, Float64]:
        """Return `_nearest` of all queries. A large search is split over the cores."""

        def nearest(some: Int8) -> tuple[Float64, Int64, Float64]:
            # Requests are searched in parallel, so FAISS uses one thread for each.
            faiss.omp_set_num_threads(1)
            return self._nearest(some, fetch)

        parts = min(CORES, len(codes))
        if parts == 1 or len(codes) * len(self) < PARALLEL:
            return nearest(codes)
        found = [*_threads.map(nearest, np.array_split(codes, parts))]
        squared, rows, complete = (np.concatenate(each) for each in zip(*found, strict=True))
        return squared, rows, complete

    @abstractmethod
    def rough(self, codes: Int8, k: int) -> tuple[Float32, Int64]:
        """Return about the k nearest rows to each query, for choosing maps to search exactly.

        Args:
            codes: queries, int8 (q, code bytes).
            k: number of rows, at most n.

        Returns:
            Squared distances in steps, rounded, float32 (q, k), ascending; and rows, int64 (q, k);
            -1 where there is none.
        """

    @abstractmethod
    def _nearest(self, codes: Int8, fetch: int) -> tuple[Float64, Int64, Float64]:
        """Return rows near each query.

        Returns:
            Exact squared distances in steps, float64 (q, fetch); their rows, int64 (q, fetch); and
            the squared distance below which no row is missing, float64 (q,).
        """


class FlatIndex(MapIndex):
    """Index that compares a query with every row, dimension by dimension.

    Levels are integers, and squared distances of up to 258 dimensions stay below 2^24, so they are
    exact in float32: they depend neither on the batch nor on the order of summation.
    """

    def __init__(self, codes: Int8, quantizer: Quantizer) -> None:
        super().__init__(codes, quantizer)
        self._index = faiss.IndexFlatL2(codes.shape[1] * quantizer.per_byte)
        self._index.codes.resize(4 * len(codes) * self._index.d)  # else it grows by doubling
        self._index.codes.resize(0)
        for start in range(0, len(codes), ROWS):
            levels = quantizer.levels(codes[start : start + ROWS])
            self._index.add(levels.astype(np.float32))

    def rough(self, codes: Int8, k: int) -> tuple[Float32, Int64]:
        """Return the k nearest rows; exact in this index."""
        faiss.omp_set_num_threads(1)
        return self._index.search(self._quantizer.levels(codes).astype(np.float32), k)

    def _nearest(self, codes: Int8, fetch: int) -> tuple[Float64, Int64, Float64]:
        levels = self._quantizer.levels(codes).astype(np.float32)
        squared, rows = self._index.search(levels, fetch)
        return squared.astype(np.float64), rows, squared[:, -1].astype(np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class Nibbles:
    """Product quantizer tables over nibbles, one set for all indexes of a code.

    Attributes:
        apart: uint16 (65,536,), squared distance of bytes a and b at index 256 a + b.
        faiss_bytes: uint8 (256,), the byte that FAISS reads in place of a code's byte.
        codebook: float32 (16, dimensions of a nibble), the levels of each nibble.
        per_nibble: number of dimensions of a nibble.
        widest: the largest squared distance of two nibbles.
    """

    apart: UInt16
    faiss_bytes: UInt8
    codebook: Float32
    per_nibble: int
    widest: int

    @classmethod
    @lru_cache(maxsize=len(LEVELS))
    def of(cls, per_byte: int) -> "Nibbles":
        """Return the tables of codes with 2 or 4 dimensions per byte, for any step.

        A table of 128 kB per index would take a megabyte per map, even for empty maps.
        """
        quantizer = Quantizer(1.0, per_byte)
        every = np.arange(256, dtype=np.uint8).view(np.int8)[:, None]
        levels = quantizer.levels(every).astype(np.int32)
        apart = ((levels[:, None] - levels[None]) ** 2).sum(axis=2).ravel()
        per_nibble = per_byte // 2
        # A nibble's value has its dimensions' digits in the quantizer's order.
        places = LEVELS[per_byte] ** np.arange(per_nibble)
        digits = (levels + quantizer.highest) // quantizer.spacing
        low, high = digits[:, :per_nibble] @ places, digits[:, per_nibble:] @ places
        codebook = np.zeros((16, per_nibble), dtype=np.float32)
        codebook[low] = levels[:, :per_nibble]
        widest = per_nibble * (2 * quantizer.highest) ** 2
        faiss_bytes = (low | high << 4).astype(np.uint8)
        return cls(apart.astype(np.uint16), faiss_bytes, codebook, per_nibble, widest)

    def index(self, codes: Int8) -> Any:
        """Return a FAISS index over codes, which are held a second time while it is built."""
        nibbles = 2 * codes.shape[1]
        plain = faiss.IndexPQ(nibbles * self.per_nibble, nibbles, 4)
        faiss.copy_array_to_vector(np.tile(self.codebook, (nibbles, 1)).ravel(), plain.pq.centroids)
        plain.is_trained = True
        plain.codes.resize(codes.size)
        room = faiss.rev_swig_ptr(plain.codes.data(), codes.size).reshape(codes.shape)
        for start in range(0, len(codes), ROWS):  # as indices they take eight times the bytes
            some = slice(start, start + ROWS)
            room[some] = self.faiss_bytes[codes[some].view(np.uint8)]
        plain.ntotal = len(codes)
        index = faiss.IndexPQFastScan(plain)  # type: ignore[arg-type]  # one of two forms
        index.implem = SCAN
        return index


class NibbleIndex(MapIndex):
    """Index that adds up the distances of nibbles.

    It takes as much memory as the codes themselves. An empty index takes none.
    """

    def __init__(self, codes: Int8, quantizer: Quantizer) -> None:
        """Index codes with 2 or 4 dimensions per byte."""
        super().__init__(codes, quantizer)
        self._tables = Nibbles.of(quantizer.per_byte)
        self._index = self._tables.index(codes) if len(codes) else None
        # FAISS rounds each nibble's distance to 1/255 of the largest, and the sum to 16 bits.
        nibbles = 2 * codes.shape[1]
        self._bound = nibbles * self._tables.widest / 2 * max(1 / 255, nibbles / 65_535)

    def rough(self, codes: Int8, k: int) -> tuple[Float32, Int64]:
        """Return about the k nearest rows, by distances that FAISS rounded."""
        assert self._index is not None  # an empty index fetches nothing
        faiss.omp_set_num_threads(1)
        levels = self._quantizer.levels(codes).astype(np.float32)
        squared, rows = self._index.search(levels, k)
        return squared, rows

    def _nearest(self, codes: Int8, fetch: int) -> tuple[Float64, Int64, Float64]:
        levels = self._quantizer.levels(codes).astype(np.float32)
        assert self._index is not None  # an empty index fetches nothing
        rounded, rows = self._index.search(levels, fetch)
        asked = codes.view(np.uint8).astype(np.uint16)[:, None] << 8
        stored = self._codes.view(np.uint8)
        squared = np.empty(rows.shape)
        step = max(1, BLOCK // max(1, rows.shape[1] * stored.shape[1]))
        for begin in range(0, len(rows), step):
            some = slice(begin, begin + step)
            squared[some] = self._tables.apart[asked[some] | stored[rows[some]]].sum(axis=2)
        return squared, rows, rounded[:, -1].astype(np.float64) - self._bound


def index_of(codes: Int8, quantizer: Quantizer) -> MapIndex:
    """Return the fastest index for codes of this quantizer."""
    kind = NibbleIndex if quantizer.per_byte in {2, 4} else FlatIndex
    return kind(codes, quantizer)


@dataclass(frozen=True, slots=True, eq=False)
class FilteredIndex:
    """Index over the rows of another one that a filter keeps.

    So the search stays exact, and takes no longer than the one in all rows.

    Attributes:
        rows: rows of the other index, int64 (m,), ascending.
        index: index over them.
    """

    rows: Int64
    index: MapIndex

    def search(self, codes: Int8, k: int, gone: Bool | None = None) -> tuple[Float64, Int64]:
        """Return the k nearest rows of the other index; see `MapIndex.search`."""
        hidden = None if gone is None else gone[self.rows]
        distances, found = self.index.search(codes, k, hidden)
        return distances, self.rows[found]

    def rough(self, codes: Int8, k: int) -> tuple[Float32, Int64]:
        """Return about the k nearest rows of the other index; see `MapIndex.rough`."""
        k = min(k, len(self.rows))
        if not k:
            return np.zeros((len(codes), 0), np.float32), np.zeros((len(codes), 0), np.int64)
        squared, found = self.index.rough(codes, k)
        return squared, np.where(found < 0, -1, self.rows[found])


@dataclass(frozen=True, slots=True)
class LayeredIndex:
    """Index over both layers of a map."""

    base: MapIndex
    recent: MapIndex

    @classmethod
    def of(
        cls, layers: MapLayers, quantizer: Quantizer, base: MapIndex | None = None
    ) -> "LayeredIndex":
        """Index both layers.

        Args:
            layers: layers of the map.
            quantizer: quantizer of the map's model.
            base: index of the base, if there is one already.
        """
        recent = index_of(layers.recent.codes, quantizer)
        return cls(base or index_of(layers.base.codes, quantizer), recent)

    def search(
        self, layers: MapLayers, codes: Int8, k: int, wanted: ClassFilter | None = None
    ) -> tuple[Float64, Int64]:
        """Return the k nearest segments to each query, over both layers.

        Args:
            layers: the indexed layers.
            codes: queries, int8 (q, code bytes).
            k: number of segments; all segments if the map has fewer.
            wanted: filter of the segments; the nearest are those of the segments that it keeps.

        Returns:
            Distances in steps of the quantizer, float64 (q, min(k, n)), ascending; and rows of
            `layers`, int64, of the same shape, by id among equal distances.
        """
        base: MapIndex | FilteredIndex = self.base
        recent: MapIndex | FilteredIndex = self.recent
        if wanted is not None:
            base = self.base.filtered(classes_of(layers.base), wanted)
            recent = self.recent.filtered(classes_of(layers.recent), wanted)
        distances, rows = base.search(codes, k, layers.gone if layers.gone_count else None)
        if not len(layers.recent):
            return distances, rows
        nearer, above = recent.search(codes, k)
        distances = np.concatenate([distances, nearer], axis=1)
        rows = np.concatenate([rows, above + len(layers.base)], axis=1)
        order = np.lexsort((layers.column("ids", rows), distances), axis=1)[:, :k]
        return np.take_along_axis(distances, order, axis=1), np.take_along_axis(rows, order, axis=1)
