"""Formats that can be written, and what decides a segment's color."""

from typing import Literal

Target = Literal["ply", "las", "pcd", "mcap", "geojson", "tum", "g2o"]
ColorBy = Literal["id", "robot", "group", "class"]
