"""What a robot needs to talk to a Placecell service: HTTP clients, compact map and delta files."""

from placecell_client.async_client import AsyncClient
from placecell_client.client import Client
from placecell_client.errors import ServiceError
from placecell_client.map_delta import Delta, decode_delta, encode_delta
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
from placecell_client.retries import Retries

__all__ = [
    "AsyncClient",
    "Candidate",
    "Client",
    "CompactMap",
    "Delta",
    "Description",
    "Info",
    "ItemError",
    "MapFileError",
    "MapSummary",
    "Matches",
    "Retries",
    "ServiceError",
    "Skipped",
    "decode",
    "decode_delta",
    "encode",
    "encode_delta",
]
