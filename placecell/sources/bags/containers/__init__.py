"""Files that hold messages: ROS 1 bags, SQLite databases, MCAP files, and bags of several."""
