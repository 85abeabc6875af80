"""Power loss: replay of recorded disk operations, cut at every moment."""
