"""Explanations of connection errors: why a service cannot be reached, and what to do."""

import ipaddress
import os
import ssl
from urllib.request import getproxies, proxy_bypass

import httpx

LOOPBACK_NAMES = frozenset({"localhost", "localhost.localdomain"})


def checked_url(base_url: str) -> httpx.URL:
    """Parse the address of a service.

    Raises:
        ValueError: The text is not a URL with scheme http or https and a host.
    """
    try:
        url = httpx.URL(base_url)
    except (httpx.InvalidURL, TypeError, ValueError) as error:
        raise ValueError(f"Invalid URL {base_url!r}: {error}. Expected http://HOST:PORT.") from None
    if url.scheme not in {"http", "https"} or not url.host:
        guess = "" if "://" in base_url else f", such as http://{base_url.lstrip('/')}"
        raise ValueError(f"Invalid URL {base_url!r}: expected http://HOST:PORT{guess}.")
    return url


def is_loopback(host: str) -> bool:
    """Return whether a host is this machine."""
    if host.lower() in LOOPBACK_NAMES:
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def proxy_of(url: httpx.URL) -> str | None:
    """Return variable and address of the proxy in the environment; None if none is used."""
    if is_loopback(url.host) or proxy_bypass(url.netloc.decode()):
        return None
    proxies = getproxies()
    for scheme in (url.scheme, "all"):
        if scheme in proxies:
            name = f"{scheme}_proxy"
            variable = name.upper() if name.upper() in os.environ else name
            try:
                proxy = httpx.URL(proxies[scheme])
            except httpx.InvalidURL:
                return f"{variable}=(not a URL)"
            # The password of the proxy is left out.
            return f"{variable}={proxy.copy_with(userinfo=b'')}"
    return None


def explained(error: httpx.TransportError, url: httpx.URL) -> str:
    """Return the error's text, with a hint what to do if one is known."""
    text = str(error) or type(error).__name__
    hints = [_hint(error, text, url)]
    proxy = proxy_of(url)
    if proxy is not None:
        hints.append(f"The request went through a proxy ({proxy}). Set NO_PROXY={url.host} if not")
    told = [hint for hint in hints if hint]
    return f"{text.rstrip('.')}. {'. '.join(told)}." if told else text


def _hint(  # noqa: PLR0911 -- a table of cases
    error: httpx.TransportError, text: str, url: httpx.URL
) -> str:
    port = "" if url.port is None else f":{url.port}"
    if "WRONG_VERSION_NUMBER" in text or "record layer failure" in text.lower():
        return f"The port does not speak TLS. Use http://{url.host}{port}"
    if "CERTIFICATE_VERIFY_FAILED" in text or isinstance(error.__context__, ssl.SSLError):
        return (
            f"The certificate of {url.host} is not trusted. Set SSL_CERT_FILE to the file of its "
            "authority, and use the host name in the certificate"
        )
    if isinstance(error, httpx.RemoteProtocolError) and url.scheme == "http":
        return f"If the port speaks TLS, use https://{url.host}{port}"
    if isinstance(error, httpx.ConnectTimeout):
        return f"Nothing answered at {url.host}{port}. Check the host, the port and the firewall"
    if isinstance(error, httpx.ReadTimeout | httpx.WriteTimeout):
        return "The service was reached but did not answer in time. Set a longer timeout"
    if "Name or service not known" in text or "nodename nor servname" in text:
        return f"The host name {url.host} is unknown. Check its spelling and the DNS"
    if isinstance(error, httpx.ConnectError):
        return f"Check that the service runs (placecell serve) and listens at {url.host}{port}"
    return ""
