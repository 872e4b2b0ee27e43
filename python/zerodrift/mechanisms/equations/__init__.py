"""From a drawing to equations: tables of the core, trees of joints, measures, and the graph from which code is generated."""
