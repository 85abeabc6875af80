"""Client addresses, grouped as limits and fair shares count them."""

import ipaddress
from functools import lru_cache

IPV6_PREFIX = 64
"""Network prefix of an IPv6 address, bits: one client has all addresses of a network."""


@lru_cache(maxsize=4_096)
def client_network(address: str) -> str:
    """Return the network that an address counts as: IPv4 itself, IPv6 its /64.

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
