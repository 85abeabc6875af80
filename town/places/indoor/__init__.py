"""Indoor floors: walls, rooms, halls, furniture, and the floors of one building."""
