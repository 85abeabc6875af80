"""Table of annotations: tags, places on the Earth and named poses of maps."""

import hashlib
import json
import logging
from collections.abc import Collection, Iterator, Sequence

from service.maps.sql.rows import Rows
from service.maps.store import Annotation

logger = logging.getLogger("placecell")


def read_annotations(
    rows: Rows, uid: str | None = None
) -> tuple[dict[str, list[Annotation]], list[str]]:
    """Return the annotations of a map or of all, by uid, and an error for each altered one."""
    found: dict[str, list[Annotation]] = {}
    errors = []
    found_rows = rows.execute(
        "SELECT uid, maps.name, maps.map, kind, annotations.name, value, author, time, "
        "annotations.digest FROM annotations JOIN maps ON maps.map = annotations.map "
        f"{'' if uid is None else 'WHERE uid = ? '}ORDER BY uid, kind, annotations.name",
        () if uid is None else (uid,),
    )
    for of, name, row, *values, digest in found_rows:
        annotation = Annotation(*values)
        if digest == digest_of(row, annotation):
            found.setdefault(of, []).append(annotation)
        else:
            errors.append(
                f"map {name!r}: {annotation.kind} {annotation.name!r} was altered in the table "
                "annotations"
            )
    return found, errors


def known_annotations(rows: Rows, uid: str | None = None) -> dict[str, list[Annotation]]:
    """Return the annotations of a map or of all, by uid; altered ones are logged and left out."""
    found, errors = read_annotations(rows, uid)
    for error in errors:
        logger.error("%s; it is not used", error)
    return found


def write_annotations(
    rows: Rows,
    row: int,
    put: Sequence[Annotation],
    removed: Collection[tuple[str, str]],
) -> None:
    """Add or replace annotations of a map, and remove some, within a transaction."""
    for kind, name in removed:
        rows.execute(
            "DELETE FROM annotations WHERE map = ? AND kind = ? AND name = ?", (row, kind, name)
        )
    for each in put:
        rows.execute(
            "INSERT INTO annotations (map, kind, name, value, author, time, digest) "
            "VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT (map, kind, name) DO UPDATE SET "
            "value = excluded.value, author = excluded.author, time = excluded.time, "
            "digest = excluded.digest",
            (
                row,
                each.kind,
                each.name,
                each.value,
                each.author,
                each.time,
                digest_of(row, each),
            ),
        )


def digest_of(row: int, annotation: Annotation) -> str:
    """Hash an annotation of a map, so that an altered row is noticed."""
    fields = [
        row,
        annotation.kind,
        annotation.name,
        annotation.value,
        annotation.author,
        float(annotation.time),
    ]
    return hashlib.sha256(json.dumps(fields).encode()).hexdigest()[:16]


def errors_in(rows: Rows) -> Iterator[str]:
    """Yield errors of the table: rows without a map, and altered rows."""
    (lost,) = rows.execute(
        "SELECT count(*) FROM annotations WHERE map NOT IN (SELECT map FROM maps)"
    ).fetchone()
    if lost:
        yield f"{lost} rows of the table annotations belong to no map"
    yield from read_annotations(rows)[1]
