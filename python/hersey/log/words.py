"""Words of German, French, Spanish, Italian, Japanese and Chinese that columns are called by."""

from __future__ import annotations


def _word(*words: str) -> str:
    """The pattern of names in which one of some words stands alone, before or behind others."""
    return rf"(.*[^a-z])?({'|'.join(words)})([^a-z].*)?"


#: Friction in other languages than German.
_FRICTION = "frottement|fricci[oó]n|rozamiento|attrito|frizione"
#: Names by role, beside those of `hersey.log.roles`, and of what stands for a torque or a speed.
NAMES = {
    "time": (
        rf"{_word('temps', 'tiempo', 'tempo', 'dur[eé]e', 'horodatage', 'zeit(stempel|punkt)')}"
        "|.*(時間|时间|時刻|时刻|日時|秒数|经过).*"
    ),
    "torque": (
        rf"(?!.*thermo){_word('couples?', 'coppia')}|par([ _](motor|resistente|de[ _].*))?"
        "|.*(トルク|扭矩|转矩|轉矩|力矩).*"
    ),
    "speed": (
        r".*(geschw(?!.*beschl)|vitesse|velocidad|velocit[aà]).*|.*drehz.*|(n(umero|[.°])? ?)?giri([^a-z].*)?"
        r"|revoluciones.*|régime.*|(?!.*加速).*(速度|回転数|転数|转速|轉速|線速|线速|周速|車速).*"
    ),
    "temperature": r".*(温度|溫度|油温|水温|室温|気温).*",
    "load": (
        r"(auf|normal)?last|.*belastung.*|anpresskraft.*|(charge|effort|force)[ _]?normale?"
        r"|carico.*|carga.*|(fuerza|forza)[ _]?normale?"
        "|(?!.*(トルク|矩)).*(荷重|载荷|荷载|載荷|法向力|正压力).*"
    ),
    "radius": "rayon.*|radio|raggio.*|半[径徑].*",
    "position": (
        r".*([aá]ngulo|angolo|posici[oó]n|posizione|codeur|位置|角度|回転角|转角|编码器|エンコーダ).*"
    ),
    "friction coefficient": (
        rf".*coef.*({_FRICTION}).*|.*reibwert.*|.*(摩擦|トラクション|牵引)(係数|系数|因数|因子).*"
    ),
    "force": rf".*({_FRICTION}).*|.*(摩擦力(?!矩)|摩擦抵抗|切向力|接線力).*",
    "belt speed": ".*(glissement|desliz|scorrimento|strisciamento|滑り|すべり|滑动|摺動|周速|搬送).*",
}
#: Names of a position along a line, in a unit of length.
MOVED = "course|d[eé]placement|recorrido|desplazamiento|corsa|spostamento|変位|ストローク|移動量|位移|行程"
#: What was asked for, not measured.
SET_POINT = (
    "consigne|consigna|cible|objetivo|obiettivo|impost[oa]|richiest[oa]|vorgabe|指令|設定|设定|目標|目标|给定"
)
#: The lubricant, beside whose temperature that of a heater or a room is another.
LUBRICANT = "huile|aceite|olio|油|グリース|潤滑|润滑"
#: A current of a motor, as words alone and within others.
CURRENT = "courant|corriente|corrente"
CURRENT_WITHIN = "(motor|anker)strom|電流|电流"
#: The time since the start, with which a clock of the day needs no question.
ELAPSED = "elapsed|time since|vergangen|[eé]coul[eé]|transcurrido|trascorso|経過|经过|经過|経过"
#: A clock of the day: what it is surely called, and by what words it may be called beside an elapsed time.
OF_THE_DAY = r"uhrzeit|datum.*|date.*|clock.*|.*time of day|heure|hora|ora|horodatage|時刻|时刻|日時|日期.*"
STAMPED = "time ?stamp|zeitstempel|time|zeit|日時|時間|时间"
#: An elapsed time that is called by nothing but its word.
TIME_ALONE = "t|time|zeit|temps|tiempo|tempo|時間|时间"
