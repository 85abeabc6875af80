"""Client addresses, grouped as limits and shares count them."""

import ipaddress
from functools import lru_cache

IPV6_PREFIX = 64
"""Bits of an IPv6 address that name a network: one client has all addresses of it."""


@lru_cache(maxsize=4_096)
def client_network(address: str) -> str:
    """Return what an address counts as: an IPv4 address itself, or the /64 of an IPv6 address.

    An IPv4 address that came to a socket of IPv6 (`::ffff:192.0.2.1`) counts as itself.
    """
    try:
        parsed = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(parsed, ipaddress.IPv4Address):
        return str(parsed)
    if parsed.ipv4_mapped is not None:
        return str(parsed.ipv4_mapped)
    return str(ipaddress.ip_network((parsed, IPV6_PREFIX), strict=False))
