"""What names of columns say, in the languages of those who log: a quantity, a unit."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from functools import lru_cache

from ... import units
from ..cells.headers import bare, unit_in

DATE, TIME, ROLL, ORDER, LOG_SPEED, OTHER = "date", "time", "roll", "order", "log speed", "other"
"""What names may say besides quantities: OTHER is anything that no trial holds."""

_PORT = r"\b(port|ps|p|bb|babord|backbord|bakboord|babor|left|links|gauche|лб)\b|\bлев|左"
_STARBOARD = r"\b(st(a?r?)b(oar)?d|sb|st ?b|tribord|steuerbord|stuurboord|estribor|right|rechts|droite|пб)\b|\bправ|右"

_STEERED = (
    r"(rudder|rud|rsa|ruder|steering|prop|shaft|helm|roer|gouvern|timon|barre|rpm|speed|course|heading|kurs"
    r"|рул|оборот|курс)"
)
_TELEGRAPH = r"telegra(ph|f)|\beot\b|テレグラフ"
_ORDERED = r"(\bsp\b|ord|cmd|comm?and|set|soll|gewenst|consigne|demand|desired|ref|задан)"

_OF_A_LOG = r"\b(stw|vbw|vlw|speed|vel|velocity|em log|doppler|dvl)\b"

_WORDS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("wind_speed_app", (
        r"(?<!gesch)wind.*(rel|app|scheinbar|schijnbaar)", r"(rel|app|scheinbar|schijnbaar)\w*[ .]*wind", r"vent app",
        r"viento (rel|ap)", r"(кажущ|относит)\w* вет", r"awa", r"aws", r"相対風", r"视风", r"相对风",
    )),
    ("wind_speed", (
        r"(?<!gesch)wind", r"\bvent", r"viento", r"vento", r"\btwd\b", r"\btws\b", r"\bвет(е?р)", r"風", r"风", r"풍",
    )),
    (OTHER, (
        r"thrust\b(?!er)", r"torque", r"power", r"\bkw\b", r"fuel", r"temp", r"pressure", r"druck", r"draft",
        r"draught", r"trim\b", r"heave", r"schub", r"drehmoment", r"leistung", r"poussee", r"couple", r"puissance",
        r"empuje", r"推力", r"トルク", r"turbo", r"\bt ?c ?\d* (rpm|speed)", r"governor", r"\bindex\b", r"generator",
        r"alternat", r"\bpump", r"\bdg ?\d",
        r"\bfan\b", r"\btrq\b", r"\bk ?nm\b", r"\bpwr\b", r"\bload\b", r"момент", r"мощност", r"топлив", r"температ",
        r"давлен", r"осадк", r"дифферент",
    )),
    (OTHER, (
        r"\bdist\b", r"distan[cz]", r"afstand", r"odomet", r"\bweg\b", r"\btrip\b", r"mileage", r"sailed", r"航程",
    )),
    (ROLL, (
        r"roll", r"heel", r"kranken", r"krangung", r"rollen", r"gite", r"roulis", r"escora", r"balanceo", r"slinger",
        r"pitch", r"stampf", r"tangage", r"\bкрен", r"качк", r"横揺", r"横摇", r"縦揺",
    )),
    ("wave_height", (
        r"wave.*(h|height)", r"\bhs\b", r"wellenhohe", r"hauteur.*vague", r"波高",
    )),
    ("wave_dir", (
        r"wave.*dir", r"wellenricht", r"波向",
    )),
    ("current_dir", (
        r"current.*(dir|set)", r"stromricht", r"流向",
    )),
    ("current_speed", (
        r"current.*(sp|vel|drift)", r"stromgeschw", r"流速",
    )),
    ("depth", (
        r"depth", r"wassertiefe", r"\btiefe", r"profond", r"diepte", r"глубин", r"水深",
    )),
    (ORDER, (
        rf"{_STEERED}.*{_ORDERED}", rf"{_ORDERED}\w*[ .]*{_STEERED}", r"指令", _TELEGRAPH,
        r"\b(order(ed)?|cmd|command(ed)?|demand(ed)?|set ?point)\b",
    )),
    ("n_bow", (
        r"bow.*thr", r"bugstrahl", r"boegschroef", r"etrave", r"バウスラスタ",
    )),
    ("n_stern", (
        r"stern.*thr", r"heckstrahl", r"スターンスラスタ",
    )),
    ("v", (
        rf"{_OF_A_LOG}.*\b(tra(ns\w*)?|lat(eral)?|athwart\w*)\b",
    )),
    ("u", (
        rf"{_OF_A_LOG}.*\b(lon|long|longi\w*)\b",
    )),
    ("latitude", (
        r"\blat", r"breite", r"latitud", r"широт", r"緯度", r"纬度", r"위도",
    )),
    ("longitude", (
        r"\blon", r"\blng\b", r"l(a|ae)nge\b", r"l(a|ae)ngen(grad|min)", r"longitud", r"lengte", r"долгот", r"経度",
        r"经度",
        r"경도",
    )),
    ("psi", (
        r"\b(gyro|compass|kompass|mag\w*) (course|kurs|koers|track)\b",
    )),
    ("cog", (
        r"\bcog\b", r"course.*ground", r"kurs.*(grund|grunn)", r"\bkurs u ?g\b", r"\bkug\b", r"\bkueg\b",
        r"grondkoers", r"koers.*grond", r"\broute\b", r"rumbo.*(fondo|efectivo)", r"track angle", r"shinro",
        r"\bcourse\b", r"\btrack\b", r"rotta", r"путев\w* угол", r"курс\w* .*(грунт|путев)", r"对地航向", r"対地針路",
        r"針路",
        r"침로",
    )),
    ("sog", (
        r"\bsog\b", r"speed.*(ground|\bog\b)", r"\bfug\b", r"fahrt uber grund", r"grondsnelheid", r"vitesse.*fond",
        r"velocidad.*fondo", r"скорост\w*.*грунт", r"对地航速", r"対地速力", r"gps.*(speed|vel)",
    )),
    (LOG_SPEED, (
        r"\bstw\b", r"\bspeed.*(water|log)", r"\bfdw\b", r"fahrt durch", r"vitesse surface", r"对水", r"対水",
        r"\blog speed", r"\blogge\b", r"\b(em|doppler|dvl|speed|ship s) ?log\b", r"^log( (kn|kts?|knots|ms|m s))?$",
        r"corredera", r"\bloch\b", r"solcometro", r"\bлаг(а|у)?\b", r"скорост\w*.*вод",
    )),
    ("r", (
        r"\brot\b", r"yaw ?(rate|vel|ang)", r"yawrate", r"rate of turn", r"turn ?rate", r"angvel", r"ang vel",
        r"gyro rate", r"gier(rate|geschw)", r"drehrate", r"dreh ?geschw", r"wende",
        r"vitesse.*(giration|lacet|rotation)", r"lacet rate", r"velocidad.*(guin|giro)", r"draaisnelheid",
        r"gier ?snelheid", r"bochtsnelheid", r"углов\w* скор", r"скор\w* (поворот|рыск)", r"角速度", r"回頭", r"转向率",
        r"转艏", r"旋回", r"\br\b", r"선회",
    )),
    ("psi", (
        r"\bhead", r"\bhdg\b", r"\bhdt\b", r"gyro", r"compass", r"\bpsi\b", r"kompass", r"\byaw\b", r"kurswinkel",
        r"steuerkurs", r"voraus ?richt", r"\bkurs\b", r"\bcap\b", r"\brumbo\b", r"proa", r"koers", r"voorligg",
        r"vorlieg", r"stevning", r"sen(sh|sy)u ?ho", r"giroscop", r"azim", r"\bprora", r"stefning", r"kurssi",
        r"\bкурс", r"компас", r"方位",
        r"艏向", r"航向", r"선수",
    )),
    ("delta", (
        r"rudder", r"\brsa\b", r"\bsteer", r"\brud\b", r"\bdelta\b", r"ruder", r"helm", r"roer", r"gouvern", r"timon",
        r"timone", r"leme",
        r"\bror\b", r"rorvinkel", r"barre", r"\bрул", r"\bперо\b", r"舵", r"타각",
    )),
    ("u", (
        r"\b(v|vel|velocity|speed) n\b",
    )),
    ("v", (
        r"\b(v|vel|velocity|speed) e\b",
    )),
    ("x", (
        r"\b(pos|position|utm|grid) n\b",
    )),
    ("y", (
        r"\b(pos|position|utm|grid) e\b",
    )),
    ("n", (
        r"\brpm\b", r"\brps\b", r"\brev", r"\bn\b", r"\bn prop", r"prop", r"shaft", r"drehzahl", r"welle",
        r"schraube", r"toeren", r"schroef", r"\bas\b", r"\btours?\b", r"helice", r"\barbre\b", r"revol", r"giri",
        r"elica", r"varvtal", r"omdr", r"оборот", r"\bвинт", r"частот\w* вращ", r"转速", r"回転", r"회전",
        r"\bregime\b",
        r"(engine|motor|maschinen?|machine|\bm ?e) ?(speed|vitesse|geschw)", r"(speed|vitesse) (engine|moteur)",
    )),
    ("v", (
        r"sway", r"\bvm?\b", r"\bvm vel", r"lateral", r"abeam", r"transvers", r"quer", r"dwars", r"travers",
        r"поперечн",
        r"\bv[ _]?y\b", r"vely\b", r"vel y", r"v east", r"east.*vel", r"vel.*east", r"左右速", r"横速", r"横向速",
    )),
    ("u", (
        r"surge", r"\bu\b", r"\bu vel", r"ahead", r"longitudinal", r"langs", r"voraus", r"forward", r"vooruit",
        r"\bv[ _]?x\b", r"velx\b", r"vel x", r"v north", r"north.*vel", r"vel.*north", r"speed", r"velocity",
        r"fahrt", r"geschw", r"snelheid", r"vitesse", r"velocidad", r"velocita", r"продольн", r"скорост", r"前後速",
        r"纵向速", r"速力",
        r"航速", r"속력",
    )),
    ("x", (
        r"north", r"nord", r"noord", r"norte", r"\bx\b", r"\bx ?pos", r"pos ?x", r"\bx ?0\b", r"\bсевер", r"北",
    )),
    ("y", (
        r"east", r"\best\b", r"\bost", r"oost", r"\beste\b", r"\by\b", r"\by ?pos", r"pos ?y", r"\by ?0\b", r"\bвосто",
        r"東",
        r"东",
    )),
    (DATE, (
        r"\bdate\b", r"datum", r"fecha", r"^data$", r"\bdata (e )?h?ora", r"\bдата", r"日付", r"日期",
        r"\b(day|month|year)\b",
        r"\b(tag|monat|jahr)\b", r"\b(dag|maand|jaar)\b", r"\b(jour|mois|annee)\b", r"\b(dia|mes|ano)\b",
        r"\b(giorno|mese|anno)\b",
    )),
    (TIME, (
        r"\btime", r"\bt\b", r"zeit", r"\buhr", r"temps", r"tijd", r"tiempo", r"\bhora", r"heure", r"tempo\b",
        r"\butc\b", r"\bgmt\b", r"stamp", r"sec(ond)?s?\b", r"sekunde", r"klok", r"時", r"时", r"시간", r"datetime",
        r"aika", r"\btid", r"\bврем", r"секунд",
    )),
)  # fmt: skip
"""Quantities by what their names have in them; what stands first is looked for first."""

_PATTERNS = tuple((quantity, re.compile("|".join(words))) for quantity, words in _WORDS)
_DIRECTION = re.compile(r"dir|angle|richtung|winkel|hoek|richt|rumbo|awa|twd|\bdd?\b|向|from|풍향|cap|angulo")
_DRIVES = ("delta", "n")
_SIDES = (re.compile(_PORT), re.compile(_STARBOARD))

_SHAFT = re.compile(
    r"shaft|prop|screw|welle|schraube|schroef|\bas\b|helice|\barbre|elica|\bejes?\b|\basse\b|aksel|propell|\bвал|винт|軸|プロペラ|轴|桨"
)
_ENGINE = re.compile(
    r"\bm ?e\b|engine|motor|moteur|masch|machine|maskin|macchina|maquina|diesel|двигат"
    r"|\bhm\b|\bmcr\b|主機|主机|엔진|機関"
)

_UNITS = {
    "knoten": "kn", "kt": "kn", "kts": "kn", "kn": "kn", "knots": "kn", "noeuds": "kn", "nudos": "kn", "nodi": "kn",
    "nd": "kn", "nds": "kn", "nœuds": "kn", "noeud": "kn", "knopen": "kn", "knop": "kn", "节": "kn", "ノット": "kn",
    "노트": "kn",
    "kmh": "km/h", "mps": "m/s", "m/sec": "m/s", "ms-1": "m/s",
    "deg t": "deg", "degt": "deg", "deg true": "deg", "°t": "deg", "deg m": "deg", "deg mag": "deg",
    "deg": "deg", "degs": "deg", "grad": "deg", "degres": "deg", "degre": "deg", "grados": "deg", "gradi": "deg",
    "graden": "deg", "gr": "deg", "º": "deg", "°": "deg", "度": "deg", "도": "deg", "rad": "rad", "radians": "rad",
    "degps": "deg/s", "deg/sec": "deg/s", "dps": "deg/s", "grad/s": "deg/s", "°/sec": "deg/s", "º/s": "deg/s",
    "grad/min": "deg/min", "deg/min": "deg/min", "°/min": "deg/min", "deg/minute": "deg/min", "degpmin": "deg/min",
    "度/秒": "deg/s", "度/s": "deg/s", "도/초": "deg/s", "度/分": "deg/min", "度/min": "deg/min", "도/분": "deg/min",
    "graden/min": "deg/min", "grados/min": "deg/min", "rads": "rad/s", "rad/sec": "rad/s", "radps": "rad/s",
    "rpm": "rpm", "u/min": "rpm", "upm": "rpm", "tr/min": "rpm", "omw/min": "rpm", "giri/min": "rpm", "t/min": "rpm",
    "回転/分": "rpm", "转/分": "rpm", "轉/分": "rpm", "회전/분": "rpm",
    "min-1": "rpm", "min^-1": "rpm", "min\u22121": "rpm", "obr/min": "rpm",
    "varv/min": "rpm", "omdr/min": "rpm", "rps": "rps", "rev/s": "rps", "u/s": "rps", "tr/s": "rps", "hz": "1/s",
    "sek": "s", "sec": "s", "msec": "ms", "metres": "m", "meter": "m", "metros": "m", "米": "m", "メートル": "m",
    "秒": "s", "초": "s", "м": "m", "м/с": "m/s", "км/ч": "km/h", "уз": "kn", "узл": "kn", "узлы": "kn", "узлов": "kn",
    "рад": "rad", "рад/с": "rad/s", "град": "deg", "град/с": "deg/s", "град/мин": "deg/min", "об/мин": "rpm",
    "об/с": "rps", "сек": "s", "гон": "gon",
}  # fmt: skip
"""Names of units beyond those that maps know, as other languages and names without brackets write them."""


@lru_cache(maxsize=4096)
def plain(name: str) -> str:
    """A name in small letters, without accents, marks and unit."""
    name = bare(name[:200])
    name = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)
    name = "".join(one for one in unicodedata.normalize("NFKD", name) if not unicodedata.combining(one))
    return " ".join(re.sub(r"[\W_]+", " ", name.lower()).split())


@lru_cache(maxsize=4096)
def quantity_named(name: str) -> str:
    """The quantity that a name speaks of, or one of the words above; "" where it says nothing."""
    text = plain(_with_rpm(name))
    if not text or len(text) > 120:
        return ""
    part = name.rpartition(".")[2]
    if part != name and part.isalpha() and (found := quantity_named(part)) in (TIME, DATE):
        return found  # wind.t is a time
    found = next((quantity for quantity, pattern in _PATTERNS if pattern.search(text)), "")
    if found == DATE and part != name:
        return quantity_named(part)  # data.eta is of a table called data
    if found in ("wind_speed", "wind_speed_app") and _DIRECTION.search(text):
        return found.replace("speed", "dir")
    if found in ("delta", "n"):
        port, starboard = (bool(side.search(text)) for side in _SIDES)
        if port != starboard:
            return f"{found}_{'port' if port else 'stbd'}"
    return found


def of_starboard(names: Sequence[str], said: Sequence[str]) -> list[int]:
    """Which columns of a rudder or shaft are that to starboard, by an S where another of the same name has a P: alone
    it may stand for anything.

    said  what each name says, as ``quantity_named`` has it
    """
    to_port = {plain(name) for name, one in zip(names, said, strict=True) if one.endswith("_port")}
    return [
        k
        for k, (name, one) in enumerate(zip(names, said, strict=True))
        if one in _DRIVES and re.sub(r"\bs\b", "p", plain(name)) in to_port
    ]


def helms(names: Sequence[str], said: Sequence[str]) -> list[int]:
    """Which columns are called a helm, beside others that are called a rudder, which follows it.

    said  what each name says, as ``quantity_named`` has it
    """
    of_rudder = [k for k, one in enumerate(said) if one.startswith("delta")]
    found = [k for k in of_rudder if re.search(r"\bhelm", plain(names[k]))]
    return found if len(found) < len(of_rudder) else []


NUMBERED = 5
"""Columns of one name and a number each, from which that is the name of the table that they are of."""


def numbered(names: Sequence[str]) -> set[int]:
    """Which columns are called alike but for a number, as "data 1", "data 2", ... of a matrix called data."""
    stems: dict[str, list[int]] = {}
    for k, name in enumerate(names):
        if found := re.fullmatch(r"(.*\D)\d+", plain(name)):
            stems.setdefault(found.group(1), []).append(k)
    return {k for columns in stems.values() if len(columns) >= NUMBERED for k in columns}


def _with_rpm(name: str) -> str:
    """A name that ends with revolutions a minute, U/min or [tr/min], with "rpm" in its place; any other as it is."""
    unit = known_unit(unit_in(name[:200]) or "")
    # What an engine does once a second is turn; of anything else that may be another rate.
    if unit in ("rpm", "rps") or (unit == "1/s" and turns(name)):
        return f"{bare(name[:200])} rpm"
    words = name[:200].split()
    turning = words and words[-1][-1] not in ")]" and known_unit(words[-1]) == "rpm"
    return " ".join([*words[:-1], "rpm"]) if turning else name


@lru_cache(maxsize=4096)
def turns(name: str) -> int:
    """What turns by a name of revolutions: 1 for the propeller or its shaft, -1 for the engine, 0 for neither."""
    text = plain(name)
    return bool(_SHAFT.search(text)) - bool(_ENGINE.search(text))


@lru_cache(maxsize=4096)
def ordered(name: str) -> str:
    """What an order is of by its name: "delta", "n", or "" for a course, a speed, or nothing that can be told."""
    if quantity_named(name) != ORDER:
        return ""
    text = plain(_with_rpm(name))
    if re.search(_TELEGRAPH, text):
        return "n"
    return next((quantity for quantity, pattern in _PATTERNS if quantity in _DRIVES and pattern.search(text)), "")


_TO_PORT, _TO_STARBOARD = (
    r"(?:port|ps?|bb|babord|backbord|bakboord|babor|left|links)",
    r"(?:st(?:a?r?)b(?:oar)?d|sb|stb|s|tribord|steuerbord|stuurboord|estribor|right|rechts)",
)
_PLUS = r"(?:\+(?:ve)?|positive?|positiv|positief|positivo)"


def magnetic(name: str) -> bool:
    """Whether a name says that a heading is that of a magnetic compass."""
    return bool(_MAGNETIC.search(plain(name)))


_MAGNETIC = re.compile(r"\bmag(n|net(ic|isch|ique|ico|ica)?)?\b|\bhdm\b")


def side_named(name: str) -> str:
    """The side to which a name says that a column is positive, as "Rudder (P+)" and "helm [+ to stbd]" do; else ""."""
    text = name[:200].lower()
    sides = {"port": _TO_PORT, "starboard": _TO_STARBOARD}
    found = [
        side
        for side, words in sides.items()
        if re.search(rf"\b(?:{words})\s*(?:is\s+|=\s*)?{_PLUS}(?!\w)", text)
        or re.search(rf"(?<!\w){_PLUS}\s*[=:]?\s*(?:to\s+)?(?:{words})\b", text)
    ]
    return found[0] if len(found) == 1 else ""


@lru_cache(maxsize=4096)
def unit_named(name: str, row: str = "") -> str:
    """The unit that a name has in it, or that stands below it; "" where none is said."""
    found = _unit_named(name, row)
    return "m/s" if found == "ms" and quantity_named(name) in _SPEEDS else found


_SPEEDS = ("u", "v", "sog", LOG_SPEED, "wind_speed", "wind_speed_app", "current_speed")
"""What is in metres a second where a name says "ms"."""


def _unit_named(name: str, row: str) -> str:
    for text in (row.strip().strip("[]()"), unit_in(name) or ""):
        if text and (known := known_unit(text)):
            return known
    words = re.split(r"[\s_]+", name.strip().lower())
    # A name that is one word alone is no unit: "s", "m" and "deg" are what people call columns.
    if len(words) == 1 and (words[0] in ("rpm", "rps") or known_unit(words[0]) == "rpm"):
        return known_unit(words[0])
    for size in (2, 1):
        if len(words) > size and (known := known_unit("/".join(words[-size:]))):
            return known
    return ""


def known_unit(text: str) -> str:
    """A unit by the program's name for it; "" where it is none."""
    folded = "".join(
        one for one in unicodedata.normalize("NFKD", text.strip().lower()) if not unicodedata.combining(one)
    )
    found = _UNITS.get(text.strip().lower()) or _UNITS.get(folded) or units.canonical(text)
    return found if any(found in units.factors(unit) for unit in KINDS) else ""


KINDS = ("m", "m/s", "rad", "rad/s", "1/s", "s")
"""Units of quantities, by which names of units are looked up."""
