"""The text of a STEP file, without the CAD kernel: names in older encodings, solids without a product.

Names in files are neither ASCII nor UTF-8 where older programs write the encoding of their country. Files do not say it. So each
encoding of `CALLED` is tried, in this order, and scored by how plausible the letters are that come out; the first one with the
highest score is taken for the whole file. No name is ever refused: bytes that the encoding does not know are read as Latin-1.
"""

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

#: Python's names of the encodings that are tried, the first of equals is taken, and what people call them.
CALLED = {
    "gb18030": "GB18030", "cp932": "Shift-JIS", "big5": "Big5", "cp949": "EUC-KR", "cp1252": "Windows-1252",
    "cp1251": "Windows-1251",
}  # fmt: skip
_HIGH = re.compile(rb"[\x80-\xff]")
_WORD = re.compile(r"[^\W\d_]+")
#: Letters that are frequent in the names of parts.
_FREQUENT = {
    "gb18030": (
        "零件装配体部图草拉伸切除轴孔板座盖支架螺栓母钉垫片齿轮箱壳底上下左右前后中心内外圆角倒面凸台基准实模"
        "型机床刀具夹头杆销键槽圈套筒管接法兰阀泵叶盘电缸活塞连油封环导轨滑块组合副本总成的不镜像阵列旋转扫描"
        "放样控制段舱测试新建特征钢铝铸固定可动移减速器弹簧涡"
    ),
    "cp932": (
        "部品組立図軸穴板受台座蓋取付金具歯車箱底上下左右前後中心内外円角面基準型機械治工頭棒溝輪管弁翼盤継手"
        "固定可動本体新規押出回転羽根減速"
    ),
    "big5": (
        "零件裝配體組圖軸孔板座蓋支架螺栓母釘墊片齒輪箱殼底上下左右前後中心內外圓角面凸台基準實模型機床刀具夾"
        "頭桿銷鍵槽圈套筒管接閥泵葉盤電缸活塞連油封環導軌滑塊合副本總成的鏡像陣列旋轉掃描控制新建特徵鋼鋁鑄固"
        "定可動移減速器彈簧渦法蘭絲帽"
    ),
    "cp949": (
        "부품하우징축기어판브라켓베링조립덮개임펠러볼트너핀홀더커버바디상좌전후측면본체플렌지샤프스실린블록레"
        "일가이드척금형몸통휠캡밸펌모터로암케소단자대중심내외경구멍고정회동센서다각날손잡나사와셔크노즐"
    ),
}
#: What a letter of a kind counts.
_SURE, _LIKELY, _ODD = 1.0, 0.6, 0.1


def typed(text: str, called: str) -> str:
    r"""A name that a person gives as the bytes or the letters that its file shows elsewhere, as it is read here.

    `called` is as of `CALLED`. A text that cannot be such bytes stays as it is.

    >>> typed("\udcb3\udcdd\udcc2\udcd6", "GB18030"), typed("³ÝÂÖ", "GB18030"), typed("齿轮", "GB18030"), typed("rim", "")
    ('齿轮', '齿轮', '齿轮', 'rim')
    """
    encoding = next((name for name, word in CALLED.items() if word == called), "")
    # A terminal hands on bytes that are not in its own encoding as halves of surrogate pairs, and the others as letters.
    raw = any("\udc80" <= letter <= "\udcff" for letter in text)
    for how in ([("utf-8", "surrogateescape")] if raw else [("latin-1", "strict"), ("cp1252", "strict")]) if encoding else ():
        try:
            return text.encode(*how).decode(encoding)
        except UnicodeError:
            continue
    return text


def is_plain(data: bytes) -> bool:
    """Whether bytes are ASCII or UTF-8."""
    try:
        data.decode()
    except UnicodeDecodeError:
        return False
    return True


def encoding_of(names: Sequence[bytes]) -> str:
    """The encoding that names are in.

    Examples
    --------
    >>> encoding_of([b"rim"]), encoding_of(["Gehäuse".encode()])
    ('utf-8', 'utf-8')
    >>> [encoding_of([name.encode(code)]) for name, code in (("齿轮", "gb18030"), ("ハウジング", "cp932"), ("Gehäuse", "cp1252"))]
    ['gb18030', 'cp932', 'cp1252']
    >>> encoding_of([])
    'utf-8'
    """
    high = [name for name in names if _HIGH.search(name)]
    if all(map(is_plain, high)):
        return "utf-8"
    return max(CALLED, key=lambda each: sum(_plausible(name, each) for name in high))


def decoded(name: bytes, encoding: str) -> str:
    """A name in an encoding; what it does not know is read as UTF-8, or else as Latin-1.

    Of an encoding of single bytes, which knows nearly all, UTF-8 is tried first; a name in GB18030 may be UTF-8 by chance.

    >>> decoded(b"\\xb3\\xdd\\xc2\\xd6", "gb18030"), decoded(b"\\xb3", "gb18030"), decoded("é".encode(), "cp1251")
    ('齿轮', '³', 'é')
    """
    for each in ("utf-8", encoding) if encoding in _WORDS else (encoding, "utf-8"):
        try:
            return name.decode(each)
        except UnicodeDecodeError:
            continue
    return name.decode("latin-1")


def _plausible(name: bytes, encoding: str) -> float:
    """How plausible a name is in an encoding: 0 to 1, for each of its bytes that is not ASCII."""
    try:
        text = name.decode(encoding)
    except UnicodeDecodeError:
        return 0.0
    letters = [letter for letter in text if ord(letter) > 0x7F]
    if encoding in _WORDS:
        total = sum(_WORDS[encoding](word) for word in _WORD.findall(text))
        # A sign of diameter, degrees or tolerance stands beside numbers in any part of Europe.
        total += _LIKELY * sum(letter in "°±µ×²³®©№" for letter in letters if not letter.isalpha() or letter == "µ")
    else:
        total = sum(_one(letter, encoding) for letter in letters)
    return len(_HIGH.findall(name)) * total / max(1, len(letters))


def _one(letter: str, encoding: str) -> float:
    """How usual a letter is where an encoding of East Asia is in use."""
    if letter in _FREQUENT.get(encoding, ""):
        return _SURE
    if encoding == "cp949":
        return _LIKELY if "가" <= letter <= "힣" and min(letter.encode("euc_kr", "replace")) >= 0xA1 else _ODD
    if encoding == "cp932" and "ぁ" <= letter <= "ー":
        return _SURE
    first, last = {"gb18030": (0xB0, 0xD7), "cp932": (0x88, 0x97), "big5": (0xA4, 0xC6)}[encoding]
    code = letter.encode({"gb18030": "gb2312"}.get(encoding, encoding), "replace")
    # The half of each standard that has the letters in daily use.
    return _LIKELY if len(code) > 1 and first <= code[0] <= last else _ODD if len(code) > 1 else 0.0


def _cyrillic(word: str) -> float:
    """Russian words stand in one case, or with a capital in front; they hold no Latin letters."""
    if any(letter < "\x80" for letter in word):
        return 0.0
    if word[1:].islower() or word.isupper():
        russian = sum("А" <= letter <= "я" or letter in "Ёё" for letter in word)
        return 0.9 * russian + 0.3 * (len(word) - russian) if len(word) > 1 else 0.3
    return 0.0


def _latin(word: str) -> float:
    """Accents are single among plain letters, in the case of their word."""
    high = [letter for letter in word if letter > "\x7f" and letter != "µ"]
    if not word[1:].islower() and not word.isupper() and len(word) > 1:
        return _ODD * len(high)
    plain = len(word) - len(high)
    return _SURE * len(high) if plain >= len(high) else _LIKELY * len(high) if len(high) == 1 else _ODD * len(high)


_WORDS: dict[str, Callable[[str], float]] = {"cp1251": _cyrillic, "cp1252": _latin}


#: Comments and strings; what stands between the apostrophes of a comment is no string.
_STRING = re.compile(rb"/\*.*?\*/|'(?:[^']|'')*'", re.DOTALL)
_FOREIGN = re.compile("[^\0-\x7f]+")
_SOLID = re.compile(rb"(#\d+)\s*=\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP|SHELL_BASED_SURFACE_MODEL)\s*\(")
_REPRESENTATION = re.compile(rb"(#\d+)\s*=\s*[A-Z_]*SHAPE_REPRESENTATION\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
_UNIT = re.compile(rb"(#\d+)\s*=\s*\(([^;]*\bLENGTH_UNIT\s*\(\s*\)[^;]*)\)\s*;")
_NUMBER = re.compile(rb"#(\d+)\s*=")
#: A product, its definition, and the representation that it is joined to.
_PRODUCT = """#{0}=APPLICATION_CONTEXT('');
#{1}=PRODUCT_CONTEXT('',#{0},'mechanical');
#{2}=PRODUCT('','','',(#{1}));
#{3}=PRODUCT_DEFINITION_FORMATION('','',#{2});
#{4}=PRODUCT_DEFINITION_CONTEXT('part definition',#{0},'design');
#{5}=PRODUCT_DEFINITION('','',#{3},#{4});
#{6}=PRODUCT_DEFINITION_SHAPE('','',#{5});
#{7}=SHAPE_DEFINITION_REPRESENTATION(#{6},{representation});
"""
_OWN = """#{0}=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#{1}=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(({unit}))REPRESENTATION_CONTEXT('',''));
#{2}=SHAPE_REPRESENTATION('',({solids}),#{1});
"""


class Adopted(NamedTuple):
    """A file whose solids got a product: its text, the solids, and what is known of their unit; empty where it is stated."""

    data: bytes
    solids: list[str]
    unit: str


def readable(data: bytes) -> tuple[bytes, str]:
    r"""A file with the names in it as the kernel can read them, and what the encoding that they were in is called.

    The second is empty, and the first as it was, where names are ASCII or UTF-8.

    Examples
    --------
    >>> readable("#1=PRODUCT('齿轮');".encode("gb18030"))
    (b"#1=PRODUCT('\\X2\\9F7F8F6E\\X0\\');", 'GB18030')
    >>> readable(b"#1=PRODUCT('rim');")
    (b"#1=PRODUCT('rim');", '')
    """
    if data.isascii() or is_plain(data):
        return data, ""
    names = {text for text in _STRING.findall(data) if text.startswith(b"'") and not text.isascii()}
    encoding = encoding_of(sorted(names))
    escaped = {name: _FOREIGN.sub(lambda match: _escaped(match[0]), decoded(name, encoding)).encode() for name in names}
    return _STRING.sub(lambda match: escaped.get(match[0], match[0]), data), CALLED.get(encoding, "")


def _escaped(text: str) -> str:
    """Letters as STEP writes those that are not ASCII."""
    if max(text) <= "\uffff":
        return f"\\X2\\{''.join(f'{ord(letter):04X}' for letter in text)}\\X0\\"
    return f"\\X4\\{''.join(f'{ord(letter):08X}' for letter in text)}\\X0\\"


def adopted(data: bytes) -> Adopted | None:
    """A file none of whose shapes belongs to a product, with a product for its solids; None where that is not needed, or not so.

    Solids in a representation keep its unit. For others the only length unit of the file is taken, or else mm.
    """
    if b"SHAPE_DEFINITION_REPRESENTATION" in data or not (solids := _SOLID.findall(data)):
        return None
    number = 1 + max(int(each) for each in _NUMBER.findall(data))
    within = {rep: {item.strip() for item in items.split(b",")} for rep, items in _REPRESENTATION.findall(data)}
    representations = [rep.decode() for rep, items in within.items() if items & set(solids)]
    lone = [each.decode() for each in solids if not any(each in items for items in within.values())]
    text, unit = "", ""
    if lone:
        named = [(each.decode(), b"CONVERSION_BASED_UNIT" in words) for each, words in _UNIT.findall(data)]
        known = [each for each, converted in named if converted] or [each for each, _ in named]
        only = len(known) == 1
        unit = f"no unit is stated for {lone[0]}" + (f", {known[0]} is the only one" if only else "")
        text += _OWN.format(*range(number, number + 3), unit=known[0] if only else f"#{number}", solids=",".join(lone))
        representations.append(f"#{number + 2}")
        number += 3
    for representation in representations:
        text += _PRODUCT.format(*range(number, number + 8), representation=representation)
        number += 8
    end = data.rindex(b"ENDSEC") if b"ENDSEC" in data else len(data)
    return Adopted(data[:end] + text.encode() + data[end:], [each.decode() for each in solids], unit)
