"""The live stream: panels cut on the server, binary frames, numbered events."""
