"""Search: nearest candidates and localization in one map or in many maps."""
