"""One run of a system: what it may be told, how it is driven, and what comes out."""
