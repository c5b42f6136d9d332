"""The text of compiled simulators, made for the parts of a model; `source` puts it together."""
