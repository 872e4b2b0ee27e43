"""Sources as functions of shared libraries, and the cache of both on disk."""
