"""C and Python sources from elementary operations."""
