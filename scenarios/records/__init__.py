"""Records of real devices: files in, records out, and the shelf on which benches find them."""
