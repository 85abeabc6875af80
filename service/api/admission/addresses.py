"""Client addresses: grouped into networks, for limits and fair shares."""

import ipaddress
from functools import lru_cache

IPV6_PREFIX = 64
"""Network prefix of an IPv6 address, bits. One client usually holds a whole network."""


@lru_cache(maxsize=4_096)
def client_network(address: str) -> str:
    """Return the network that an address counts as: an IPv4 address or an IPv6 /64 network.

    An IPv4 address in IPv6 form (`::ffff:192.0.2.1`) counts as the IPv4 address.
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
