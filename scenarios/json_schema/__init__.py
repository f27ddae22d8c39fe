"""JSON Schemas of the documents that people write, made from what reads them."""
