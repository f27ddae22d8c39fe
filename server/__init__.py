"""The service around the bench: REST, WebSocket, 3D, records."""

import scenarios  # noqa: F401  (names the folder of compiled kernels)
