"""Evaluation of recognition: retrieval, match classification and the study."""
