//! What may be written in YAML: pipelines and presets, with their places for error messages.
