"""Map file, version 1: a `CompactMap` in at most 48 bytes per segment.

`docs/reference/map-file.md` describes each byte, for readers in any language. Equal maps are equal
files; `decode` refuses all bytes that `encode` does not make.
"""

from placecell_client.maps import container
from placecell_client.maps.canonical import canonical
from placecell_client.maps.columns import REQUIRED, columns_of, header_of, map_of
from placecell_client.maps.compact_map import ODOMETRY_COLUMNS, OPTIONAL, CompactMap, MapFileError
from placecell_client.maps.container import Content, FileFormat

__all__ = ["FORMAT", "MEDIA_TYPE", "VERSION", "CompactMap", "MapFileError", "decode", "encode"]

FORMAT = "placecell-map"
VERSION = 1
MEDIA_TYPE = "application/vnd.placecell.map"

_MAP_FILE = FileFormat(
    FORMAT, "map file", VERSION, REQUIRED, frozenset({*OPTIONAL, *ODOMETRY_COLUMNS})
)


def encode(compact_map: CompactMap) -> bytes:
    """Encode a map as a file.

    Rows are sorted by id. Robots and captures are sorted; duplicates and unused ones are left out.
    Centroids are rounded to whole centimeters.

    Raises:
        MapFileError: The map is invalid, or a segment is more than 327.67 m away from its sensor
            along an axis.
    """
    return container.write(_content(compact_map))


def decode(data: bytes) -> CompactMap:
    """Decode a map file.

    Raises:
        MapFileError: The bytes are not exactly those that `encode` makes of a map.
    """
    content, checksum = container.read(data, _MAP_FILE)
    compact_map = map_of(content.header, content.columns)
    # This one check covers order, widths, rounding and the spelling of the header.
    if not container.is_file_of(data, _content(compact_map), checksum):
        raise MapFileError("the file is not in canonical form: encode the map again")
    return compact_map


def _content(compact_map: CompactMap) -> Content:
    compact_map.check()
    ordered = canonical(compact_map)
    header = {"format": FORMAT, "version": VERSION} | header_of(ordered)
    return Content(header, columns_of(ordered))
