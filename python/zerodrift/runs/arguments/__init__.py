"""Arguments of a run, read and checked: methods, settings, inputs, outputs and events."""
