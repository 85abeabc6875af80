"""Writers of point cloud files: PLY, LAS and PCD."""

from pathlib import Path

import numpy as np

from placecell.core.types import UInt8
from placecell.export.content import ExportContent

PLY_TYPES = {"f8": "double", "u1": "uchar", "u2": "ushort", "u4": "uint"}
LAS_STEP = 0.001
"""Resolution of coordinates in LAS files, meters."""


def write_ply(content: ExportContent, color: UInt8, file: Path) -> None:
    """Write a binary PLY file: x, y, z, red, green, blue, id, robot, group."""
    names = ("x", "y", "z", "red", "green", "blue", "id", "robot", "group")
    kinds = ("f8", "f8", "f8", "u1", "u1", "u1", "u4", "u2", "u4")
    table = np.empty(len(content.points), [(n, f"<{k}") for n, k in zip(names, kinds, strict=True)])
    for axis, name in enumerate("xyz"):
        table[name] = content.points[:, axis]
    for band, name in enumerate(("red", "green", "blue")):
        table[name] = color[content.owners, band]
    table["id"] = content.ids[content.owners]
    table["robot"] = content.robot[content.owners]
    table["group"] = content.groups[content.owners]
    lines = ["ply", "format binary_little_endian 1.0", f"comment frame {content.frame}"]
    lines += [f"comment robot {index} {name}" for index, name in enumerate(content.robots)]
    lines.append(f"element vertex {len(table)}")
    lines += [f"property {PLY_TYPES[k]} {n}" for n, k in zip(names, kinds, strict=True)]
    with file.open("wb") as stream:
        stream.write(("\n".join([*lines, "end_header"]) + "\n").encode())
        stream.write(table.tobytes())


def write_las(content: ExportContent, color: UInt8, file: Path) -> None:
    """Write a LAS 1.4 file with colors, and the extra dimensions segment, robot and group."""
    import laspy

    header = laspy.LasHeader(point_format=7, version="1.4")
    header.scales = np.full(3, LAS_STEP)
    header.offsets = np.floor(content.points.min(axis=0)) if len(content.points) else np.zeros(3)
    for name, kind in (("segment", np.uint32), ("robot", np.uint16), ("group", np.uint32)):
        header.add_extra_dim(laspy.ExtraBytesParams(name, kind))
    las = laspy.LasData(header)
    las.x, las.y, las.z = content.points.T
    red, green, blue = (color[content.owners].astype(np.uint16) * 257).T
    las.red, las.green, las.blue = red, green, blue
    las["segment"] = content.ids[content.owners].astype(np.uint32)
    las["robot"] = content.robot[content.owners].astype(np.uint16)
    las["group"] = content.groups[content.owners].astype(np.uint32)
    with file.open("wb") as stream:
        las.write(stream)


def write_pcd(content: ExportContent, color: UInt8, file: Path) -> None:
    """Write a binary PCD file: x, y, z, rgb, id, robot, group; rgb is packed as PCL does."""
    from pypcd4.pypcd4 import Encoding, PointCloud

    wide = color[content.owners].astype(np.uint32)
    packed = (wide[:, 0] << 16) | (wide[:, 1] << 8) | wide[:, 2]
    columns = [
        *content.points.astype(np.float32).T,
        packed.view(np.float32),
        content.ids[content.owners].astype(np.uint32),
        content.robot[content.owners].astype(np.uint32),
        content.groups[content.owners].astype(np.uint32),
    ]
    kinds = (*(np.float32,) * 4, *(np.uint32,) * 3)
    names = ("x", "y", "z", "rgb", "id", "robot", "group")
    cloud = PointCloud.from_points(columns, names, kinds)
    cloud.save(file, encoding=Encoding.BINARY)
