"""Version of the installed program."""

from importlib import metadata


def version() -> str:
    """Return the version of the installed Placecell; `unknown` in a checkout without one."""
    try:
        return metadata.version("placecell")
    except metadata.PackageNotFoundError:
        return "unknown"
