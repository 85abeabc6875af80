from tests.training_sets import other_views, shapes

__all__ = ["other_views", "shapes"]
