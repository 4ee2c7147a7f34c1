"""Pieces of work handed out to workers: processes of this machine, or a cluster's."""
