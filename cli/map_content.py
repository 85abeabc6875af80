"""Content of a map file for `placecell export`."""

from pathlib import Path

from placecell_client.maps.compact_map import MapFileError
from placecell_client.maps.map_file import decode

from placecell.export.content import ExportContent, read_recording
from placecell.segmentation.recording import RecordingError
from service.clouds.map_export import content_of_map


def read_content(file: Path) -> ExportContent:
    """Read a map file or a recording.

    Raises:
        ValueError: the file is neither.
    """
    if not file.is_file():
        raise ValueError(f"{file}: no such file. Give a map file or a recording (.safetensors)")
    try:
        return read_recording(file)
    except RecordingError as error:
        if file.suffix == ".safetensors":
            raise ValueError(f"{error}. Give a map file or a recording") from error
    try:
        return of_map(file)
    except MapFileError as error:
        raise ValueError(
            f"{file}: neither a recording of segments nor a map file ({error}). Write a recording "
            "with 'placecell prepare', or a map file with 'placecell maps pull'"
        ) from error


def of_map(file: Path) -> ExportContent:
    """Return the content of a map file: one point a segment.

    Raises:
        MapFileError: the file is no map file.
    """
    return content_of_map(decode(file.read_bytes()))
