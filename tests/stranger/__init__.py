"""Ships of another hand: a plant that shares no equation's code with the program, careless logs of it, and a score."""
