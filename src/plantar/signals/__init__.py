"""Signals on one time base: resampling, filters, spikes, the IMU's attitude."""
