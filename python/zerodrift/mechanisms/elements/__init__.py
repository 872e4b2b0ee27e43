"""Elements as they were given: bodies, joints, forces, user functions, and the drawing that holds them."""
