"""What a segment is: drives in, segments out, the model's input. No torch, no web."""
