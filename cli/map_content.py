"""Content of a map file for `placecell export`."""

from pathlib import Path

from placecell_client.maps.compact_map import CompactMap, MapFileError
from placecell_client.maps.map_file import decode

from placecell.core.segment_classes import ClassFilter
from placecell.export.content import ExportContent, read_recording
from placecell.segmentation.recording import RecordingError
from service.clouds.map_export import content_of_map
from service.maps.layers import of_wanted


def read_content(file: Path, wanted: ClassFilter | None = None) -> ExportContent:
    """Read a map file or a recording.

    Args:
        file: the file.
        wanted: filter of the segments by their class; None keeps all.

    Raises:
        ValueError: the file is neither, or it has no classes to filter by.
    """
    if not file.is_file():
        raise ValueError(f"{file}: no such file. Give a map file or a recording (.safetensors)")
    try:
        recording = read_recording(file)
    except RecordingError as error:
        if file.suffix == ".safetensors":
            raise ValueError(f"{error}. Give a map file or a recording") from error
    else:
        if wanted is not None:
            raise ValueError(
                f"{file} is a recording, and recordings have no classes. Give a map file, or leave "
                "out --classes and --ignore."
            )
        return recording
    try:
        return of_map(file, wanted)
    except MapFileError as error:
        raise ValueError(
            f"{file}: neither a recording of segments nor a map file ({error}). Write a recording "
            "with 'placecell prepare', or a map file with 'placecell maps pull'"
        ) from error


def of_map(file: Path, wanted: ClassFilter | None = None) -> ExportContent:
    """Return the content of a map file: one point a segment.

    Raises:
        MapFileError: the file is no map file.
        ValueError: the map has no classes to filter by.
    """
    return content_of_map(filtered(decode(file.read_bytes()), wanted, str(file)))


def filtered(content: CompactMap, wanted: ClassFilter | None, name: str) -> CompactMap:
    """Return a map without the segments that a filter leaves out.

    Args:
        content: the map.
        wanted: the filter; None keeps all.
        name: name of the map in errors.

    Raises:
        ValueError: the map has no classes to filter by.
    """
    if wanted is not None and content.classes is None:
        raise ValueError(
            f"{name} has no classes. Store it again with a model that has classes, such as "
            "context, or leave out --classes and --ignore."
        )
    return of_wanted(content, wanted)
