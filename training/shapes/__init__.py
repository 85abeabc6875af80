"""Training of the shape decoder, which turns stored codes back into occupancy grids."""
