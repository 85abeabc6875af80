"""Sources of scans: one class per format of files, behind one interface.

A source yields scans. A drive (`placecell.datasets`) is a source with a pose for each scan.
"""

from placecell.sources.errors import DriveError
from placecell.sources.scan import LidarScan
from placecell.sources.scan_options import ScanOptions, parse_columns, use_scan_options
from placecell.sources.source import ScanSource

__all__ = [
    "DriveError",
    "LidarScan",
    "ScanOptions",
    "ScanSource",
    "parse_columns",
    "use_scan_options",
]
