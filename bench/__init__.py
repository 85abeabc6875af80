"""What measures the whole from outside: the demo, load generators, peers."""
