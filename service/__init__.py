"""The service: segments in over HTTP, descriptors and matches out, maps kept."""
