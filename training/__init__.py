"""The paper's trainings and experiments (sections III and IV): recordings in, models out.

Read in the paper's order: `training_set` and `augmentation` (III-A, preprocessing), `networks`
(III-B, the feature extraction network), `group_based` (III-C), `export` to ONNX, `evaluation`
(IV, experiments). Torch is imported here and nowhere else.
"""
