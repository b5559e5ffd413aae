"""Joints of a log: under the right names, read by encoders that live, closing the chain of two legs."""
