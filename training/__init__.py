"""Training of models from recordings, and the paper's experiments (sections III and IV).

Read in the paper's order: `training_set` and `augmentation` (III-A, preprocessing), `networks`
(III-B, the feature extraction network), `group_based` (III-C), `siamese` (III-D), `contrastive`
(III-E), `pair_classifier` (the secondary classifier), `recognition` and `evaluation` (IV-B, how
methods are compared), `experiments` and `report` (IV, the whole). `export` and `publishing` make a
model's folder of what was learned. Torch is imported here and nowhere else.
"""
