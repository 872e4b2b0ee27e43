"""Elements of a mechanism, as defined: bodies, joints, forces, user functions, and the drawing that holds them."""
