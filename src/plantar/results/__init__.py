"""What an identification found, as data: the contract of `result.json`."""
