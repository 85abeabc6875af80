"""Generated parts of the reference pages: commands, settings, metrics, routes and schemas."""
