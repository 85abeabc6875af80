"""What a robot needs to talk to a Placecell service: an HTTP client and the compact map file."""

from placecell_client.client import Client
from placecell_client.errors import ServiceError
from placecell_client.map_file import CompactMap, MapFileError, decode, encode
from placecell_client.results import (
    Candidate,
    Description,
    Info,
    ItemError,
    MapSummary,
    Matches,
    Skipped,
)

__all__ = [
    "Candidate",
    "Client",
    "CompactMap",
    "Description",
    "Info",
    "ItemError",
    "MapFileError",
    "MapSummary",
    "Matches",
    "ServiceError",
    "Skipped",
    "decode",
    "encode",
]
