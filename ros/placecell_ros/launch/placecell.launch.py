"""Launch file: the agent, and RViz if it is asked for."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

ARGUMENTS = {
    "map": (None, "Name of the map on the service."),
    "service": ("http://127.0.0.1:8000", "Address of the service."),
    "points": ("points", "Topic of the clouds, sensor_msgs/PointCloud2."),
    "odom": ("odom", "Topic of the odometry, nav_msgs/Odometry."),
    "use_sim_time": ("false", "Use the clock of a simulation or a bag."),
    "rviz": ("false", "Start RViz."),
}


def generate_launch_description() -> LaunchDescription:
    """Return the agent's node and RViz."""
    share = FindPackageShare("placecell_ros")
    value = {name: LaunchConfiguration(name) for name in (*ARGUMENTS, "params_file")}
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    declared.append(
        DeclareLaunchArgument(
            "params_file",
            default_value=PathJoinSubstitution([share, "config", "params.yaml"]),
            description="File with the other parameters.",
        )
    )
    # Without the type, a map named 2026 or "on" would be a number or a boolean.
    texts = {name: ParameterValue(value[name], value_type=str) for name in ("map", "service")}
    sim_time = {"use_sim_time": ParameterValue(value["use_sim_time"], value_type=bool)}
    agent = Node(
        package="placecell_ros",
        executable="agent",
        name="placecell",
        output="screen",
        parameters=[value["params_file"], texts | sim_time],
        remappings=[("points", value["points"]), ("odom", value["odom"])],
        sigterm_timeout="15",  # the agent sends its last edits
    )
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", PathJoinSubstitution([share, "rviz", "placecell.rviz"])],
        parameters=[sim_time],
        condition=IfCondition(value["rviz"]),
    )
    return LaunchDescription([*declared, agent, rviz])
