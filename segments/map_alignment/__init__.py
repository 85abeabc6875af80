"""How two robots' maps lie to each other, from their descriptors and centroids alone."""

from segments.map_alignment.align import align_all
