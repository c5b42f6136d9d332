"""A ship with an effect hidden in her, to judge a diagnosis by: equations, steps and noise of her own."""
