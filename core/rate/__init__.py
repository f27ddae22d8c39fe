"""What turns the device: generators of angular rate."""
