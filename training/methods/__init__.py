"""Training methods: group-based, Siamese, contrastive, metric and context."""
