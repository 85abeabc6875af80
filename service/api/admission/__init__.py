"""Admission control: lanes, fair threads, and receiving and streaming of bodies."""
