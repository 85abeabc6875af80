"""Inference: from request segments to descriptors, with the loaded models."""
