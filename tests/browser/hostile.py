"""Sixty names as a stranger may write them into a file: each must be shown, none may do anything."""

from __future__ import annotations

MARKUP = (
    "<script>alert(1)</script>",
    "</script><script>alert(2)</script>",
    "</SCRIPT ><ScRiPt>alert(3)</sCrIpT>",
    "<img src=x onerror=alert(4)>",
    "<img/src='x'/onerror=alert(5)//",
    "<svg/onload=alert(6)>",
    "<svg><script>alert(7)</script></svg>",
    "</text></svg><img src=x onerror=alert(8)>",
    "<iframe srcdoc='<script>parent.alert(9)</script>'></iframe>",
    "</style><script>alert(10)</script>",
    "</title><script>alert(11)</script>",
    "</textarea></noscript><body onload=alert(12)>",
    "<!-- <script> -->",
    "<!--<script>alert(13)//--></script>",
    "<![CDATA[<script>alert(14)</script>]]>",
    "]]><script>alert(15)</script>",
    "<base href='https://example.invalid/'>",
    "<meta http-equiv=refresh content='0;url=https://example.invalid/'>",
    "<details open ontoggle=alert(16)>",
    "&lt;script&gt;alert(17)&lt;/script&gt; &#60;b&#62; &nbsp",
)
ADDRESSES = (
    "javascript:alert(18)",
    "data:text/html,<script>alert(19)</script>",
    "//example.invalid/pixel.png",
    "https://example.invalid/?q=1",
    "file:///etc/hostname",
    '<a href="javascript:alert(20)">here</a>',
    "<link rel=stylesheet href=//example.invalid/a.css>",
    "![picture](https://example.invalid/x.png)",
)
EXPRESSIONS = (
    '{"signal": "alert(21)"}',
    '{"expr": "datum.x"}',
    "datum['a']",
    "datum.a.b",
    "a.b.c:Q",
    "a[0]",
    "a\\.b\\[0\\]",
    "count()",
    "mean(x):Q",
    'it\'s "quoted" `thus`',
    "\\",
    "\\'); alert(22); //",
    '"+alert(23)+"',
    "event.view.alert(24)",
    "toString.constructor('alert(25)')()",
    "[].constructor.constructor('alert(26)')()",
    "__proto__",
    "constructor",
    "image",
)
STYLES = (
    "expression(alert(27))",
    "url(https://example.invalid/x.png)",
    "}</style><style>body{display:none}",
    "x;background:url(//example.invalid/y)",
)
SIGNS = (
    "\u202egpj.exe",
    "\u2066isolated\u2069 \u200fright",
    "zero\u200bwidth\ufeff\u00ad",
    "\x1b[31mred\x1b[0m\x07",
    "\x85\x9b31m",
    "half \ud83d of a pair",
    "{{7*7}} ${7*7} {% raw %} #{7*7}",
    "%s %n %1$s {0} {name!r}",
    "long " * 800,
)
NAMES = (*MARKUP, *ADDRESSES, *EXPRESSIONS, *STYLES, *SIGNS)
#: Those that a line of a text file holds.
ON_A_LINE = tuple(name for name in NAMES if name.isprintable() or name in SIGNS[:3] or name in SIGNS[6:])
