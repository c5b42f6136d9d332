"""Around a fitted point: what an effect would change that re-tuning cannot imitate, and what follows from it.

linear            signatures beyond re-tuning
screening         the score of each hypothesis, and of chance; hierarchy: of values of each run
foretelling       gains of a step before anything is refitted; beside: what is free beside a hypothesis
intervals         how well sizes are known; wording: as text
retuned           coefficients that came out far from the profile's
"""
