"""The compact map file, version 1: a `CompactMap` in at most 48 bytes a segment.

`docs/reference/map-file.md` describes it byte by byte, for readers in any language. `decode` takes
exactly what `encode` gives: equal maps are equal files, and any other bytes are refused.
"""

from placecell_client.maps import container
from placecell_client.maps.canonical import canonical
from placecell_client.maps.columns import REQUIRED, columns_of, header_of, map_of
from placecell_client.maps.compact_map import OPTIONAL, CompactMap, MapFileError
from placecell_client.maps.container import Content, FileFormat

__all__ = ["FORMAT", "MEDIA_TYPE", "VERSION", "CompactMap", "MapFileError", "decode", "encode"]

FORMAT = "placecell-map"
VERSION = 1
MEDIA_TYPE = "application/vnd.placecell.map"

_MAP_FILE = FileFormat(FORMAT, "map file", VERSION, REQUIRED, frozenset(OPTIONAL))


def encode(compact_map: CompactMap) -> bytes:
    """The map as a file.

    Rows are sorted by id; robots and frames are sorted, merged where equal, and left out where no
    segment names them; centroids are rounded to whole centimetres.

    Raises:
        MapFileError: the map is not valid, or a segment is more than 327.67 m along an axis from
            the sensor that took it.
    """
    return container.write(_content(compact_map))


def decode(data: bytes) -> CompactMap:
    """The map of a file.

    Raises:
        MapFileError: the bytes are not exactly what `encode` makes of a map.
    """
    content, checksum = container.read(data, _MAP_FILE)
    compact_map = map_of(content.header, content.columns)
    # One rule for all that is left: order, widths, rounding, spelling of the header.
    if not container.is_file_of(data, _content(compact_map), checksum):
        raise MapFileError("the file is not in canonical form: encode the map again")
    return compact_map


def _content(compact_map: CompactMap) -> Content:
    compact_map.check()
    ordered = canonical(compact_map)
    header = {"format": FORMAT, "version": VERSION} | header_of(ordered)
    return Content(header, columns_of(ordered))
