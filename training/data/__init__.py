"""Training data: the training set and its augmentation (paper III-A)."""
