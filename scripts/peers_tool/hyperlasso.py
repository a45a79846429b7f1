"""hyperlasso on models and formulas; see the package."""

from peers_tool import Peer


class Tool(Peer):
    peer = "hyperlasso"
