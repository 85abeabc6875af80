"""The paper's experiments and the ablations (paper IV)."""
