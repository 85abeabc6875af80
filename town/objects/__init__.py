"""Objects along the streets: houses, furniture, vegetation and cars."""
