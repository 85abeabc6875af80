"""Arrays of a JSON request, parsed by compiled code while other threads run.

A request consists mostly of numbers: the points of its segments, or codes and centroids. A parser
that makes a Python object of each number holds the interpreter's lock for the whole body (140 ms
for 11 MB), and no other request is answered meanwhile. So compiled code first cuts the arrays out
of the body, without the lock, into NumPy arrays. The rest is small, and pydantic parses it.

Numbers are parsed by Clinger's fast path and else by the method of Eisel and Lemire ("Number
parsing at a gigabyte per second", 2021). Both round correctly. `float` parses the few numbers that
neither method can decide.
"""

import re
import secrets
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from placecell_client.maps.compact_map import COORDINATE_LIMIT

from placecell.core.jit import compiled, compiled_part
from placecell.core.types import Float64, Int8, Int64

POINTS, CENTROIDS, CODES = 0, 1, 2
NAMES = ("points", "centroids", "codes")
STAND_INS = (b"[]", b"[[0,0,0]]", b"[[]]")
"""Valid arrays that replace arrays of each kind while a body is searched for errors."""
LONGEST_ROW = 1 << 16
"""Largest size of an invalid point or code that is parsed again to describe its error, bytes."""

# Columns of `spans`, one row for each array.
BEGIN, END, KIND, FIRST, ROWS, BAD = range(6)
# Elements of `tally`.
SPANS, FLOAT_ROWS, POINT_ROWS, INTS, CODE_ROWS, HARD, VALUES, SYNTAX_AT, SYNTAX, DEPTH = range(10)
# Columns of `bad`. Each row is the first array of one kind that has an error.
BAD_ROW, BAD_BEGIN, BAD_END = range(3)

DEEPEST = 200
"""Largest depth of nested lists and objects. Pydantic's parser has the same limit."""

SYNTAX_ERRORS = {
    1: "EOF while parsing a list",
    2: "trailing comma",
    3: "expected `,` or `]`",
    4: "recursion limit exceeded",
}

Bytes = NDArray[np.uint8]
Words = NDArray[np.uint64]

SMALLEST_POWER, LARGEST_POWER = -342, 308


def _powers_of_five() -> Words:
    """Return 128 bits of 5^q for each q, most significant word first."""
    powers = []
    for q in range(SMALLEST_POWER, LARGEST_POWER + 1):
        power = 5 ** abs(q)
        if q < 0:
            bits = (power - 1).bit_length()
            power = (1 << (bits + 127 if q >= -27 else 2 * bits + 128)) // power + 1
        surplus = power.bit_length() - 128
        power = power >> surplus if surplus > 0 else power << -surplus
        powers.append((power >> 64, power & ((1 << 64) - 1)))
    return np.array(powers, dtype=np.uint64)


_POWERS = _powers_of_five()
_TENS = np.array([10.0**q for q in range(23)])
_WHOLE_TENS = np.array([10**q for q in range(9)], dtype=np.uint64)
_DE_BRUIJN = 0x03F79D71B4CB0A89
_PLACES = np.zeros(64, dtype=np.uint8)
for _place in range(8):
    _PLACES[(_DE_BRUIJN << 8 * _place + 7) % (1 << 64) >> 58] = _place


@dataclass(slots=True)
class Arrays:
    """Arrays that were cut out of a body.

    Attributes:
        body: complete body.
        token: text that precedes the number of an array in the place of the array.
        spans: int64 (arrays, 6): begin and end in the body, kind, first row, number of rows, and 1
            if the array has an error.
        floats: float64 (rows, 3): rows of points and centroids.
        codes: int8 (values,): values of codes.
        lengths: int64 (rows,): number of values of each code.
        bad: int64 (kinds, 3): row with an error, and its begin and end in the body; -1 for none.
        amounts: numbers of arrays of points, rows of points and rows of codes in the body, those
            beyond the limits included.
        complete: True if all values were kept.
        values: number of lists, objects and commas outside the arrays.
        syntax: error in the body's JSON and its position; None if there is no error.
        text: body with the arrays cut out.
    """

    body: bytes
    token: str
    spans: Int64
    floats: Float64
    codes: Int8
    lengths: Int64
    bad: Int64
    amounts: tuple[int, int, int]
    complete: bool
    values: int
    syntax: tuple[str, int] | None
    text: bytes = b""
    _pieces: list[tuple[int, int]] = field(default_factory=list)

    def rows(self, value: object, kind: int) -> Float64 | None:
        """Return the points or centroids of an array that was cut out, float64 (rows, 3).

        Returns:
            None if the value does not name such an array, or if the array has an error.
        """
        span = self._span(value, kind)
        return None if span is None else self.floats[span[0] : sum(span)]

    def code_rows(self, value: object) -> Int8 | list[list[int]] | None:
        """Return the codes of an array that was cut out.

        Returns:
            int8 (rows, bytes); a list for each row if the rows differ in length; None if the value
            does not name such an array.
        """
        span = self._span(value, CODES)
        if span is None:
            return None
        first, rows = span
        ends = np.cumsum(self.lengths)
        begin = int(ends[first - 1]) if first else 0
        lengths = self.lengths[first : first + rows]
        own = self.codes[begin : int(ends[first + rows - 1])]
        if (lengths == lengths[0]).all():
            return own.reshape(rows, -1) if lengths[0] else np.empty((rows, 0), dtype=np.int8)
        return [each.tolist() for each in np.split(own, np.cumsum(lengths)[:-1])]

    def _span(self, value: object, kind: int) -> tuple[int, int] | None:
        """Return the first row and the number of rows of a valid array; None otherwise."""
        if not isinstance(value, str) or not value.startswith(self.token):
            return None
        _, _, found, first, rows, bad = self.spans[int(value[len(self.token) :])].tolist()
        return None if found != kind or bad else (first, rows)

    def named(self) -> bytes:
        """Return the body without its valid arrays; `place` maps positions back.

        Raises:
            ValueError: a row with an error is too long to be parsed again.
        """
        shown = set[int]()
        stand_ins = []
        for begin, end, kind, _, _, bad in self.spans.tolist():
            stand_in, source = STAND_INS[kind], begin
            if bad and kind not in shown:
                shown.add(kind)
                row, start, stop = self.bad[kind].tolist()
                if stop - start > LONGEST_ROW:
                    raise ValueError(f"row {row} of {NAMES[kind]!r} is {stop - start} bytes long")
                close = b"]" if stop < len(self.body) else b""
                stand_in, source = b"[" + self.body[start:stop] + close, start - 1
            stand_ins.append((begin, end, stand_in, source))
        return self._joined(stand_ins)

    def row_of(self, kind: int) -> int:
        """Return the row that stands in place of row 0 in `named`; 0 if there is none."""
        return max(int(self.bad[kind, BAD_ROW]), 0)

    def place(self, line: int, column: int, named: bytes) -> tuple[int, int]:
        """Return the line and column in the body for a position in `named`."""
        start = 0
        for _ in range(line - 1):
            start = named.find(b"\n", start) + 1
        shown = start + column
        here, there = max((piece for piece in self._pieces if piece[0] <= shown), default=(0, 0))
        offset = min(there + shown - here, len(self.body))
        before = self.body.rfind(b"\n", 0, offset) + 1
        return self.body.count(b"\n", 0, offset) + 1, offset - before

    def cut(self) -> None:
        """Cut the arrays out of the body into `text`."""
        self.text = self._joined(
            [
                (begin, end, f'"{self.token}{number}"'.encode(), begin)
                for number, (begin, end) in enumerate(self.spans[:, :2].tolist())
            ]
        )

    def _joined(self, stand_ins: list[tuple[int, int, bytes, int]]) -> bytes:
        """Return the body with a stand-in for each array, and record its original position."""
        view, parts, past, length = memoryview(self.body), list[bytes | memoryview](), 0, 0
        self._pieces = [(0, 0)]
        for begin, end, stand_in, source in stand_ins:
            parts += [view[past:begin], stand_in]
            length += begin - past
            self._pieces += [(length, source), (length + len(stand_in), end)]
            length += len(stand_in)
            past = end
        parts.append(view[past:])
        return b"".join(parts)


def cut_arrays(body: bytes, *, points: int, segments: int, values: int) -> Arrays:
    """Cut the arrays out of a JSON body, without the interpreter's lock.

    Args:
        body: body of a request; any bytes.
        points: largest number of points to keep; further points are only counted.
        segments: largest number of arrays of points, centroids and codes to keep.
        values: largest number of values of codes to keep.
    """
    data = np.frombuffer(body, np.uint8)
    # The eight bytes that begin at each position.
    words = np.ndarray((max(len(body) - 7, 0),), "<u8", body, strides=(1,))
    rows = min(points + segments, len(body) // 8 + 1)  # the shortest row is [0,0,0],
    floats = np.empty((rows, 3))
    codes = np.empty(min(values, len(body) // 2 + 1), dtype=np.int8)
    lengths = np.empty(min(segments, len(body) // 3 + 1), dtype=np.int64)
    spans = np.empty((min(segments, len(body) // 12 + 1) + 8, 6), dtype=np.int64)
    hard = np.empty((3 * rows + 3, 3), dtype=np.int64)
    bad = np.full((3, 3), -1, dtype=np.int64)
    tally = np.zeros(10, dtype=np.int64)
    amount = np.zeros(1, dtype=np.int64)
    flat = floats.reshape(-1)
    _scan(data, words, flat, flat.view(np.uint64), codes, lengths, spans, hard, bad, tally, amount)
    found = tally.tolist()
    arrays = Arrays(
        body=body,
        token=secrets.token_hex(8) + ":",
        spans=spans[: min(found[SPANS], len(spans))],
        floats=floats,
        codes=codes[: found[INTS]],
        lengths=lengths[: found[CODE_ROWS]],
        bad=bad,
        amounts=(int(amount[0]), found[POINT_ROWS], found[CODE_ROWS]),
        complete=found[SPANS] <= len(spans)
        and found[FLOAT_ROWS] <= len(floats)
        and found[CODE_ROWS] <= len(lengths)
        and found[INTS] <= len(codes),
        values=found[VALUES],
        syntax=(SYNTAX_ERRORS[found[SYNTAX]], found[SYNTAX_AT]) if found[SYNTAX] else None,
    )
    for index, begin, end in hard[: found[HARD]].tolist():
        flat[index] = float(body[begin:end])
        if not abs(flat[index]) <= COORDINATE_LIMIT:
            _mark(arrays, index // 3, begin)
    return arrays


def warm() -> None:
    """Compile the functions before the first request."""
    cut_arrays(b'{"points":[[0.5,0,0]],"codes":[[1]]}', points=1, segments=1, values=1)


def _mark(arrays: Arrays, row: int, place: int) -> None:
    """Mark a row of points or centroids as invalid."""
    for span in arrays.spans:
        if span[KIND] != CODES and span[FIRST] <= row < span[FIRST] + span[ROWS]:
            span[BAD] = 1
            entry = arrays.bad[span[KIND]]
            begin = arrays.body.rfind(b"[", 0, place)
            if entry[BAD_BEGIN] < 0 or begin < entry[BAD_BEGIN]:
                end = arrays.body.find(b"]", place) + 1
                entry[:] = row - int(span[FIRST]), begin, end


def moved(message: str, arrays: Arrays, named: bytes) -> str:
    """Return a parser's message about `named` with positions in the body."""

    def of_body(match: "re.Match[str]") -> str:
        line, column = arrays.place(int(match[1]), int(match[2]), named)
        return f" at line {line} column {column}"

    return re.sub(r" at line (\d+) column (\d+)", of_body, message)


@compiled_part
def _past_space(data: Bytes, i: int) -> int:
    while i < len(data) and (data[i] == 32 or data[i] == 10 or data[i] == 13 or data[i] == 9):
        i += 1
    return i


@compiled_part
def _past_string(data: Bytes, i: int) -> int:
    """Return the position after the string that begins at i."""
    i += 1
    while i < len(data) and data[i] != 34:
        i += 2 if data[i] == 92 else 1
    return min(i + 1, len(data))


@compiled_part
def _past_value(data: Bytes, i: int, comma: bool) -> int:
    """Return the position of the bracket that closes the value at i, or of a comma before it."""
    depth = 0
    while i < len(data):
        c = data[i]
        if c == 34:
            i = _past_string(data, i)
            continue
        if depth == 0 and (c in (93, 125) or (comma and c == 44)):
            return i
        if c in (91, 123):
            depth += 1
        elif c in (93, 125):
            depth -= 1
        i += 1
    return len(data)


@compiled_part
def _hexadecimal(c: int) -> int:
    if 48 <= c <= 57:
        return c - 48
    c |= 32
    return c - 87 if 97 <= c <= 102 else -1


@compiled_part
def _kind_of(data: Bytes, begin: int, end: int) -> int:
    """Return the kind of array that a key names, or -1; letters may be escaped."""
    kinds = 7  # one bit for each possible kind
    names = (b"points", b"centroids", b"codes")
    at = 0
    i = begin
    while i < end:
        c = int(data[i])
        i += 1
        if c == 92:
            if i + 5 > end or data[i] != 117:
                return -1
            c = 0
            for digit in range(4):
                value = _hexadecimal(int(data[i + 1 + digit]))
                if value < 0:
                    return -1
                c = 16 * c + value
            i += 5
        for kind in range(3):
            name = names[kind]
            if at >= len(name) or int(name[at]) != c:
                kinds &= ~(1 << kind)
        if kinds == 0:
            return -1
        at += 1
    for kind in range(3):
        if kinds >> kind & 1 and len(names[kind]) == at:
            return kind
    return -1


@compiled_part
def _first_digits(data: Bytes, begin: int, end: int) -> tuple[np.uint64, int, bool]:
    """Return the first 19 digits, the number of further digits, and whether any of these is not 0.

    Leading zeros do not count.
    """
    digits, count, left, more = np.uint64(0), 0, 0, False
    for i in range(begin, end):
        if data[i] == 46:
            continue
        if count < 19:
            digits = digits * np.uint64(10) + np.uint64(data[i] - 48)
            count += digits != np.uint64(0)
        else:
            left += 1
            more |= data[i] != 48
    return digits, left, more


@compiled_part
def _number(  # noqa: PLR0912 -- one pass over the bytes
    data: Bytes, i: int
) -> tuple[int, np.uint64, int, bool, bool, bool]:
    """Parse the JSON number that begins at position i.

    Returns:
        Position after the number, -1 if there is no number; its first 19 digits; its power of ten;
        True if it is negative; True if it is an integer; True if nonzero digits were left out.
    """
    n = len(data)
    ten, nine, zero = np.uint64(10), np.uint64(9), np.uint64(48)
    digits = np.uint64(0)
    negative = i < n and data[i] == 45
    if negative:
        i += 1
    begin = i
    while i < n:
        digit = np.uint64(data[i]) - zero
        if digit > nine:
            break
        digits = digits * ten + digit
        i += 1
    count = i - begin
    if count == 0 or (count > 1 and data[begin] == 48):
        return -1, digits, 0, False, False, False
    whole = True
    power = 0
    if i < n and data[i] == 46:
        whole = False
        i += 1
        point = i
        while i < n:
            digit = np.uint64(data[i]) - zero
            if digit > nine:
                break
            digits = digits * ten + digit
            i += 1
        power = point - i
        if power == 0:
            return -1, digits, 0, False, False, False
    more = False
    if count - power > 19:
        digits, left, more = _first_digits(data, begin, i)
        power += left
    if i < n and (data[i] == 101 or data[i] == 69):
        whole = False
        i += 1
        below = False
        if i < n and (data[i] == 43 or data[i] == 45):
            below = data[i] == 45
            i += 1
        point = i
        exponent = 0
        while i < n and 48 <= data[i] <= 57:
            exponent = min(10 * exponent + int(data[i] - 48), 1 << 40)
            i += 1
        if i == point:
            return -1, digits, 0, False, False, False
        power += -exponent if below else exponent
    return i, digits, power, negative, whole, more


@compiled_part
def _product(a: np.uint64, b: np.uint64) -> tuple[np.uint64, np.uint64]:
    """Return the 128 bits of a product, most significant word first."""
    half = np.uint64(32)
    mask = np.uint64(0xFFFFFFFF)
    a0, a1, b0, b1 = a & mask, a >> half, b & mask, b >> half
    low = a0 * b0
    mid = a1 * b0 + (low >> half)
    other = a0 * b1 + (mid & mask)
    return a1 * b1 + (mid >> half) + (other >> half), (other << half) | (low & mask)


@compiled_part
def _double(w: np.uint64, q: int) -> tuple[np.uint64, bool]:
    """Return the bits of the float64 nearest to w * 10^q, and whether they are certain.

    w is not 0. Names are those of the paper. Subnormal results are never certain.
    """
    none = np.uint64(0)
    if q < SMALLEST_POWER or q > LARGEST_POWER:
        return none, False
    one = np.uint64(1)
    zeros = 0
    for bits in (32, 16, 8, 4, 2, 1):
        shift = bits * int(w < one << np.uint64(64 - bits))  # without a branch
        w = w << np.uint64(shift)
        zeros += shift
    row = q - SMALLEST_POWER
    high, low = _product(w, _POWERS[row, 0])
    mask = np.uint64(0xFFFFFFFFFFFFFFFF) >> np.uint64(55)
    if high & mask == mask:
        more, _ = _product(w, _POWERS[row, 1])
        low = low + more
        if more > low:
            high = high + one
    if low == np.uint64(0xFFFFFFFFFFFFFFFF) and (q < -27 or q > 55):
        return none, False
    upper = int(high >> np.uint64(63))
    drop = np.uint64(upper + 64 - 52 - 3)
    mantissa = high >> drop
    exponent = ((217706 * q) >> 16) + 63 + upper - zeros + 1023
    if exponent <= 0 or exponent >= 0x7FE:
        return none, False
    if low <= one and -4 <= q <= 23 and mantissa & np.uint64(3) == one and mantissa << drop == high:
        mantissa = mantissa & ~one  # halfway between two numbers: round to even
    mantissa = (mantissa + (mantissa & one)) >> one
    if mantissa >= np.uint64(1) << np.uint64(53):
        mantissa = one << np.uint64(52)
        exponent += 1
    mantissa = mantissa & ~(one << np.uint64(52))
    return mantissa | (np.uint64(exponent) << np.uint64(52)), True


@compiled_part
def _digits(word: np.uint64) -> tuple[np.uint64, int]:
    """Return the value and the number of leading digits of eight bytes, without a branch."""
    word = word ^ np.uint64(0x3030303030303030)
    other = (word | (word + np.uint64(0x7676767676767676))) & np.uint64(0x8080808080808080)
    # A byte above 0x8F could carry into the next byte, but the first byte that differs is right.
    lowest = other & (~other + np.uint64(1))
    count = int(_PLACES[(lowest * np.uint64(_DE_BRUIJN)) >> np.uint64(58)]) if other else 8
    if count == 0:
        return np.uint64(0), 0
    word = word << np.uint64(64 - 8 * count)
    word = word * np.uint64(10) + (word >> np.uint64(8))
    low = (word & np.uint64(0x000000FF000000FF)) * np.uint64(0x000F424000000064)
    high = ((word >> np.uint64(16)) & np.uint64(0x000000FF000000FF)) * np.uint64(0x0000271000000001)
    return (low + high) >> np.uint64(32), count


@compiled_part
def _coordinate(
    data: Bytes,
    i: int,
    place: int,
    floats: Float64,
    bits: Words,
    hard: Int64,
    tally: Int64,
) -> int:
    """Store the coordinate at position i; return the position after it, or -1 for an error."""
    end, w, q, negative, _, more = _number(data, i)
    if end < 0:
        return -1
    if w == np.uint64(0):
        value = 0.0
    elif not more and w <= np.uint64(1 << 53) and -22 <= q <= 22:
        value = float(w) / _TENS[-q] if q < 0 else float(w) * _TENS[q]
    else:
        word, settled = _double(w, q)
        if more or not settled:
            if q > LARGEST_POWER:
                return -1
            if place < len(floats):
                hard[tally[HARD], 0] = place
                hard[tally[HARD], 1] = i
                hard[tally[HARD], 2] = end
                tally[HARD] += 1
            return end
        if place >= len(floats):
            return end
        bits[place] = word
        value = floats[place]
    if value > COORDINATE_LIMIT:
        return -1
    if place < len(floats):
        floats[place] = -value if negative else value
    return end


@compiled_part
def _code(data: Bytes, i: int, place: int, codes: Int8) -> int:
    """Store the code value at position i; return the position after it, or -1 for an error."""
    end, w, _, negative, whole, _ = _number(data, i)
    if end < 0 or not whole or w > np.uint64(128) or (w == np.uint64(128) and not negative):
        return -1
    # A number with more digits than were kept is larger than 128.
    if place < len(codes):
        codes[place] = np.int8(-int(w) if negative else int(w))
    return end


@compiled_part
def _row(  # noqa: PLR0911
    data: Bytes,
    i: int,
    kind: int,
    first: int,
    floats: Float64,
    bits: Words,
    codes: Int8,
    hard: Int64,
    tally: Int64,
) -> tuple[int, int]:
    """Store a row; return the position after it, or -1 for an error, and its number of values."""
    n = len(data)
    if i >= n or data[i] != 91:
        return -1, 0
    i = _past_space(data, i + 1)
    count = 0
    if kind == CODES and i < n and data[i] == 93:
        return i + 1, 0
    while True:
        if kind == CODES:
            i = _code(data, i, first + count, codes)
        elif count == 3:
            return -1, count
        else:
            i = _coordinate(data, i, first + count, floats, bits, hard, tally)
        if i < 0:
            return -1, count
        count += 1
        i = _past_space(data, i)
        if i >= n:
            return -1, count
        if data[i] == 93:
            return i + 1 if kind == CODES or count == 3 else -1, count
        if data[i] != 44:
            return -1, count
        i = _past_space(data, i + 1)


@compiled_part
def _usual_rows(  # noqa: PLR0911, PLR0912, PLR0915 -- function calls would dominate the time
    data: Bytes, words: Words, i: int, place: int, floats: Float64, bits: Words
) -> tuple[int, int]:
    """Store rows of points in plain notation, such as [1.5,-0.25,12].

    The loop calls inlined functions only, because passing arrays takes longer than parsing a
    number.

    Args:
        data: bytes of the body.
        words: the eight bytes that begin at each position.
        i: position of the first row.
        place: index of its first value in `floats`.
        floats: float64 (rows, 3) to fill.
        bits: the same memory as uint64.

    Returns:
        Position after the last row that was stored, and the number of rows.
    """
    n, most = len(data), len(floats)
    one, ten, zero = np.uint64(1), np.uint64(10), np.uint64(48)
    rows = 0
    after = i
    while True:
        if i >= n or data[i] != 91 or place + 3 > most:
            return after, rows
        i += 1
        for column in range(3):
            while i < n and (data[i] == 32 or data[i] == 10 or data[i] == 13 or data[i] == 9):
                i += 1
            if i + 48 > n:
                return after, rows
            negative = data[i] == 45
            i += int(negative)
            first = data[i]
            w, count = _digits(words[i])
            i += count
            if count in (0, 8) or (count > 1 and first == 48):
                return after, rows
            q = 0
            if data[i] == 46:
                i += 1
                more, q = _digits(words[i])
                w = w * _WHOLE_TENS[q] + more
                i += q
                if q == 0:
                    return after, rows
                if q == 8:
                    more, places = _digits(words[i])
                    w = w * _WHOLE_TENS[places] + more
                    i += places
                    q += places
                    if q == 16:
                        digit = np.uint64(data[i]) - zero
                        while digit < ten and count + q < 19:
                            w = w * ten + digit
                            i += 1
                            q += 1
                            digit = np.uint64(data[i]) - zero
                if count + q > 19:
                    return after, rows
            while i < n and (data[i] == 32 or data[i] == 10 or data[i] == 13 or data[i] == 9):
                i += 1
            if i >= n or data[i] != (93 if column == 2 else 44):
                return after, rows
            i += 1
            if w <= np.uint64(1 << 53) and q <= 22:
                floats[place] = float(w) / _TENS[q]
            else:
                word, settled = _double(w, -q)
                if not settled:
                    return after, rows
                bits[place] = word
            if floats[place] > COORDINATE_LIMIT:
                return after, rows
            if negative:
                bits[place] ^= one << np.uint64(63)
            place += 1
        rows += 1
        after = i
        i = _past_space(data, i)
        if i >= n or data[i] != 44:
            return after, rows
        i = _past_space(data, i + 1)


@compiled
def _scan(  # noqa: PLR0912, PLR0915 -- one look at each byte
    data: Bytes,
    words: Words,
    floats: Float64,
    bits: Words,
    codes: Int8,
    lengths: Int64,
    spans: Int64,
    hard: Int64,
    bad: Int64,
    tally: Int64,
    point_arrays: Int64,
) -> None:
    """Fill the arrays of `cut_arrays` in one pass over the bytes."""
    n = len(data)
    i = 0
    while i < n:
        c = data[i]
        if c == 91 or c == 123 or c == 44:  # noqa: PLR1714 -- compiled
            tally[VALUES] += 1
        if c == 91 or c == 123:  # noqa: PLR1714 -- compiled
            tally[DEPTH] += 1
            if tally[DEPTH] > DEEPEST:
                tally[SYNTAX] = 4
                tally[SYNTAX_AT] = i
                return
        elif c == 93 or c == 125:  # noqa: PLR1714 -- compiled
            tally[DEPTH] -= 1
        if c != 34:
            i += 1
            continue
        begin = i + 1
        i = _past_string(data, i)
        end = i - 1
        after = _past_space(data, i)
        if after >= n or data[after] != 58:
            continue
        after = _past_space(data, after + 1)
        i = after
        if after >= n or data[after] != 91:
            continue
        kind = _kind_of(data, begin, end)
        if kind < 0:
            continue
        begin = after
        i = _past_space(data, begin + 1)
        if i < n and data[i] == 93:
            i += 1  # an empty array stays in the text
            tally[VALUES] += 1
            point_arrays[0] += kind == POINTS
            continue
        rows, wrong = 0, 0
        first = tally[CODE_ROWS] if kind == CODES else tally[FLOAT_ROWS]
        hard_before = tally[HARD]
        while True:
            start = i
            count, place = 0, tally[INTS]
            if kind != CODES:
                place = 3 * tally[FLOAT_ROWS]
                i, usual = _usual_rows(data, words, i, place, floats, bits)
                if usual:
                    rows += usual - 1
                    tally[FLOAT_ROWS] += usual - 1
                    tally[POINT_ROWS] += (usual - 1) * (kind == POINTS)
                    count = 3
            if count == 0:
                i, count = _row(data, i, kind, place, floats, bits, codes, hard, tally)
            if i < 0:
                wrong = 1
                tally[HARD] = hard_before
                stop = _past_value(data, start, True)
                if bad[kind, BAD_ROW] < 0:
                    bad[kind, BAD_ROW] = rows
                    bad[kind, BAD_BEGIN] = start
                    bad[kind, BAD_END] = stop
                i = _past_value(data, stop, False) + 1
                break
            rows += 1
            if kind == CODES:
                if tally[CODE_ROWS] < len(lengths):
                    lengths[tally[CODE_ROWS]] = count
                tally[CODE_ROWS] += 1
                tally[INTS] += count
            else:
                tally[FLOAT_ROWS] += 1
                tally[POINT_ROWS] += kind == POINTS
            i = _past_space(data, i)
            if i < n and data[i] == 93:
                i += 1
                break
            if i < n and data[i] == 44:
                i = _past_space(data, i + 1)
                if i < n and data[i] != 93:
                    continue
                tally[SYNTAX] = 2
            else:
                tally[SYNTAX] = 3
            if i >= n:
                tally[SYNTAX] = 1
            tally[SYNTAX_AT] = min(i, n - 1)
            return
        point_arrays[0] += kind == POINTS
        number = tally[SPANS]
        if number < len(spans):
            spans[number, BEGIN] = begin
            spans[number, END] = min(i, n)
            spans[number, KIND] = kind
            spans[number, FIRST] = first
            spans[number, ROWS] = rows
            spans[number, BAD] = wrong
        tally[SPANS] += 1
