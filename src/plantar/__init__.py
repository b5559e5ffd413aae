"""plantar: what does your legged robot stand on?"""

__version__ = "0.1.0"
