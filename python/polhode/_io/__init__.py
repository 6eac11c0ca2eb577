"""Files of attitudes and motions in the formats of other programs."""
