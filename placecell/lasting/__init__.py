"""Long life of maps: which segments a later pass confirms, and which are gone."""
