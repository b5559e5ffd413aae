"""SDFormat models, Drake's dialect among them."""
