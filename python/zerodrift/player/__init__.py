"""Player: films of motions in one HTML file, without a network."""
