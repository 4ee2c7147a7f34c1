"""What a recurrent agent remembers of the blade: linear probes of its hidden units."""
