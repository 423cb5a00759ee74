"""What `peers.py` is made of: scenes, programs, measurements and the report."""
