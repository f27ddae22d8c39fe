"""What people ask the server to compute, in processes of their own with limits."""
