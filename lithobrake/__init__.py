"""Where does a lander end up on a small body whose soil nobody knows, and how sure are we?"""

__version__ = "0.1.0"
