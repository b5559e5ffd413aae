"""A robot in MuJoCo that stands on known bushes and records what a real one would."""

from plantar.twin.bush import GUESSES, PAPER, Bush
from plantar.twin.play import play, play_all, write_campaign
from plantar.twin.presets import PRESETS
from plantar.twin.recording import TwinRecording

__all__ = ["GUESSES", "PAPER", "PRESETS", "Bush", "TwinRecording", "play", "play_all", "write_campaign"]
