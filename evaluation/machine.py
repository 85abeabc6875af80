"""Machine: the processor and system that a figure was measured on."""

import platform
from pathlib import Path
from typing import Any

from placecell.core.processors import available_cores


def machine() -> dict[str, Any]:
    """Return processor, number of cores, system and Python version, as reports state them."""
    return {
        "processor": processor_name(),
        "cores": available_cores(),
        "system": platform.system(),
        "python": platform.python_version(),
    }


def processor_name() -> str:
    """Return the name of the processor, or its architecture if the name is unknown."""
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
