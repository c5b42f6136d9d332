"""Where components are from."""

SUYAMA = "Suyama et al. 2023, arXiv:2312.04224"
OKUDA = "Okuda et al. 2023, Applied Ocean Research 135, 103567"
YASUKAWA = "Yasukawa & Yoshimura 2015, J. Marine Science and Technology 20, 37-52"
YOSHIMURA = (
    "Yoshimura, Nakao & Ishibashi 2009, unified mathematical model for ocean and harbour manoeuvring, MARSIM 2009"
)
INOUE = "Inoue, Hirano & Kijima 1981, Int. Shipbuilding Progress 28, 112-125"
KIJIMA = "Kijima et al. 1990, J. Society of Naval Architects of Japan 168, 247-256"
MATHIOUDAKIS = "Mathioudakis et al., Towards real-world validation of a physics-based ship motion prediction model"
MIYAUCHI = "Miyauchi et al. 2022, J. Marine Science and Technology, doi 10.1007/s00773-022-00889-3"
KANG = "Kang, Nagarajan, Hasegawa & Sano 2008, J. Marine Science and Technology 13, 207-222"
KOBAYASHI = "Kobayashi 1988, Mitsubishi Technical Bulletin 180"
WAKITA = (
    "Wakita, Akimoto & Maki, Probabilistic prediction of ship maneuvering motion using ensemble learning with "
    "feedforward neural networks"
)
