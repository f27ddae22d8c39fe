"""The 3D view: a viser scene per bench, served through our own port. The rest works without this folder."""
