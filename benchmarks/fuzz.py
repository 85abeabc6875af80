"""Coverage-guided fuzzing of all readers of foreign bytes (Atheris, libFuzzer).

    python -m benchmarks.fuzz msgpack -atheris_runs=1000000 [CORPUS]
    python -m benchmarks.fuzz map -atheris_runs=1000000 [CORPUS]
    python -m benchmarks.fuzz delta -atheris_runs=1000000 [CORPUS]

A reader must accept an input or refuse it with its own error. Fuzzing stops at an input that does
neither, or that exceeds the memory limit, and writes that input to a file. Keep each finding as a
test.
"""

import sys
from pathlib import Path

import atheris

with atheris.instrument_imports(
    include=["placecell_client", "service.api.body.msgpack_codec", "service.api.schemas.msgpack"]
):
    import msgpack  # type: ignore[import-untyped]
    import numpy as np
    from placecell_client import (
        CompactMap,
        Delta,
        MapFileError,
        decode,
        decode_delta,
        encode,
        encode_delta,
        originated,
    )
    from placecell_client.maps import container
    from placecell_client.maps.edit import apply, with_optional
    from pydantic import ValidationError

    from service.api.body import msgpack_codec
    from service.api.schemas.msgpack import (
        PackedDescribeRequest,
        PackedLocalizeRequest,
        PackedMatchRequest,
    )
    from service.core.problems import Problem, invalid
    from service.core.settings import Limits

MEMORY_LIMIT_MB = 1024
"""Memory limit of the process, imported modules included, MB."""

LIMITS = Limits()


def read_msgpack(data: bytes) -> None:
    """Read a request body as `/describe`, `/match` or `/localize` do."""
    schema = (PackedDescribeRequest, PackedMatchRequest, PackedLocalizeRequest)[len(data) % 3]
    try:
        schema.model_validate(msgpack_codec.unpack(data, LIMITS))
    except Problem:
        pass
    except ValidationError as error:
        invalid(error)  # each validation error must have a problem response


def read_map(data: bytes) -> None:
    """Read a map file; an accepted file must survive encoding and decoding."""
    try:
        content = decode(data)
    except MapFileError:
        return
    assert encode(decode(encode(content))) == encode(content)


def read_delta(data: bytes) -> None:
    """Read a delta file; an accepted delta must survive encoding, and apply twice as once."""
    try:
        delta = decode_delta(data)
    except MapFileError:
        return
    assert encode_delta(decode_delta(encode_delta(delta))) == encode_delta(delta)
    once = apply(delta.changed, delta)
    assert encode(apply(once, delta)) == encode(once)


def seeds() -> dict[str, list[bytes]]:
    """Return valid inputs of each reader."""
    points = np.arange(30, dtype="<f4").tobytes()
    segment = {"points": points, "sensor": [0.0, 1.0, 2]}
    bodies = [
        {"segments": [segment, segment], "origin": [1.0, 2.0, 3.0]},
        {"segments": [segment], "maps": ["yard"], "k": 3},
        {"model_id": "m", "codes": bytes(64), "k": 1, "maps": ["a", "b"]},
        {"model_id": "m", "codes": bytes(64), "centroids": bytes(48), "session": "s"},
    ]
    small = CompactMap(
        model_id="m",
        preprocessing="1",
        frame="f",
        codes=np.arange(24, dtype=np.int8).reshape(3, 8),
        centroids=np.array([[0.0, 1, 2], [3, 4, 5], [6, 7, 8]]),
        ids=np.array([1, 5, 9], np.uint32),
        robots=("a",),
        robot=np.zeros(3, np.uint16),
        frame_index=np.array([0, 0, 1], np.uint32),
        frame_times=np.array([0.0, 1.0]),
        frame_positions=np.zeros((2, 3)),
        frame_orientations=np.array([[0, 0, 0, 1]] * 2, np.float32),
    )
    full = with_optional(small, ("extents", "points", "views", "seen"))
    merged = originated(full, "yard")
    gone = np.array([2, 3], np.uint32)
    return {
        "msgpack": [msgpack.packb(body) for body in bodies],
        "map": [encode(small), encode(full), encode(merged)],
        "delta": [
            encode_delta(Delta(small, gone, 3, 4)),
            encode_delta(Delta(full, gone)),
            encode_delta(Delta(merged, gone)),
        ],
    }


def main() -> None:
    """Fuzz one reader; pass all other arguments to libFuzzer."""
    # A fuzzer cannot guess a SHA-256. Without the check it reaches the code behind the check.
    container._checksum = lambda *_: "unsealed"
    reader = {"msgpack": read_msgpack, "map": read_map, "delta": read_delta}[sys.argv[1]]
    corpus = Path("out/fuzz") / sys.argv[1]
    corpus.mkdir(parents=True, exist_ok=True)
    for number, seed in enumerate(seeds()[sys.argv[1]]):
        (corpus / f"seed-{number}").write_bytes(seed)
    options = [f"-rss_limit_mb={MEMORY_LIMIT_MB}", "-max_len=4096", "-timeout=10"]
    atheris.Setup([sys.argv[0], *options, *sys.argv[2:], str(corpus)], reader)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
