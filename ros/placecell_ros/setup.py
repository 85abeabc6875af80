"""Installation of the ROS 2 package; colcon runs it."""

from pathlib import Path

from setuptools import setup

NAME = "placecell_ros"


def files(folder: str, pattern: str) -> list[str]:
    """Return the files of a folder, relative to this one."""
    here = Path(__file__).resolve().parent
    return [each.relative_to(here).as_posix() for each in sorted((here / folder).glob(pattern))]


setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", files("launch", "*.launch.py")),
        (f"share/{NAME}/config", files("config", "*.yaml")),
        (f"share/{NAME}/rviz", files("rviz", "*.rviz")),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="The Placecell maintainers",
    maintainer_email="maintainers@placecell.example",
    description="Localizes a robot in the shared maps of a Placecell service.",
    license="Apache-2.0",
    entry_points={"console_scripts": ["agent = placecell_ros.agent_node:main"]},
)
