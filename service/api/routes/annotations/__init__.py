"""Routes about annotations: tags and anchors of maps."""
