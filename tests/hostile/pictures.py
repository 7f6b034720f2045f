"""Rows of run.py: pictures and videos that are broken, lie, or unpack to far more data."""
import io
import struct
import subprocess
import zlib

from PIL import Image

from rows import LIMIT, OK, REFUSED, asset, check


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width=4, height=4, depth=8, colour=2, before=b"", pixels=None, interlace=0, end=True):
    """Returns a PNG file with any header, chunks `before` its pixels, and compressed `pixels`."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}.get(colour, 3)
    row = b"\0" + bytes((width * channels * depth + 7) // 8 if width < 1 << 16 else 8)
    data = zlib.compress(row * min(height, 1 << 12)) if pixels is None else pixels
    header = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlace)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + before + chunk(b"IDAT", data) +
            (chunk(b"IEND", b"") if end else b""))


BOMB = zlib.compress(bytes(1 << 26), 9)  # 64 MiB in 65 kB


def pngs():
    bombs = {
        "zTXt": 30 * chunk(b"zTXt", b"a\0\0" + BOMB), "iCCP": chunk(b"iCCP", b"a\0\0" + BOMB),
        "iTXt": 30 * chunk(b"iTXt", b"a\0\1\0\0\0" + BOMB), "sPLT": 50 * chunk(b"sPLT", b"a\0\x08" + bytes(60000)),
        "eXIf": chunk(b"eXIf", bytes(1 << 20)), "unknown": 100 * chunk(b"abCd", bytes(10000)),
        "texts": 5000 * chunk(b"tEXt", b"key\0value"),
    }
    for label, before in bombs.items():
        yield asset("pictures", "atlas", f"PNG {label} bomb", "a.png", png(before=before), OK, smoke=label == "zTXt")
    yield asset("pictures", "atlas", "PNG pixel bomb", "a.png", png(16384, 4096, 8, 6, pixels=zlib.compress(bytes(1 << 28), 9)),
                LIMIT, lambda: check("--limits", "asset_pixels=1000000"), smoke=True)
    sizes = {"no pixels": (0, 0), "wide": (0x7fffffff, 1), "high": (1, 0x7fffffff), "most": (0x7fffffff, 0x7fffffff),
             "many": (16384, 16384), "negative": (0x80000000, 4)}
    for label, (width, height) in sizes.items():
        yield asset("pictures", "sky", f"PNG {label}", "a.png", png(width, height))
    broken = {
        "cut": png()[:-30], "without an end": png(end=False), "without data": png(pixels=b""),
        "short data": png(40, 40, pixels=zlib.compress(bytes(10))), "wrong sum": png().replace(b"IDAT", b"IDAT" + b"\x78", 1)[:-1] + b"\x82",
        "depth": png(depth=7), "colour": png(colour=5), "interlace": png(interlace=9), "palette missing": png(colour=3),
        "head alone": b"\x89PNG\r\n\x1a\n", "length": b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 0xffffffff) + b"IHDR",
        "empty": b"", "text": b"hello", "zeros": bytes(1000), "not zlib": png(pixels=b"\xff" * 100),
    }
    for i, (label, data) in enumerate(broken.items()):
        yield asset("pictures", ("atlas", "floor", "terrain")[i % 3], f"PNG {label}", "a.png", data, *[OK] * (label == "without an end"),
                    smoke=label == "cut")


def encoded(kind, **options):
    out = io.BytesIO()
    Image.new("RGB", (16, 16), (200, 90, 10)).save(out, kind, **options)
    return out.getvalue()


def patched(data, at, new):
    """Returns the data with new bytes in place of those at an offset."""
    return data[:at] + new + data[at + len(new):]


HDR = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n%s\n-Y %d +X %d\n"


def others():
    jpeg, bmp, tiff, webp = encoded("JPEG"), encoded("BMP"), encoded("TIFF"), encoded("WEBP")
    frame = jpeg.index(b"\xff\xc0") + 5
    exif = b"\xff\xe1" + struct.pack(">H", 65535) + bytes(65533)
    tiff_loop = b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", 0) + struct.pack("<I", 8)
    tags = [(256, 3, 1, 65535), (257, 3, 1, 65535), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 0x7fffffff, 8),
            (277, 3, 1, 1), (278, 4, 1, 1), (279, 4, 0x7fffffff, 8)]
    tiff_strips = b"II*\0" + struct.pack("<IH", 8, len(tags)) + b"".join(struct.pack("<HHII", *t) for t in tags) + bytes(4)
    files = {
        "JPEG size": ("a.jpg", patched(jpeg, frame, b"\xff\xff\xff\xff")), "JPEG no size": ("a.jpg", patched(jpeg, frame, bytes(4))),
        "JPEG cut": ("a.jpg", jpeg[:-40]), "JPEG head": ("a.jpg", b"\xff\xd8\xff"),
        "JPEG segments": ("a.jpg", jpeg[:2] + 200 * exif + jpeg[2:]),
        "BMP size": ("a.bmp", patched(bmp, 18, struct.pack("<ii", 0x7fffffff, 0x7fffffff))),
        "BMP negative": ("a.bmp", patched(bmp, 18, struct.pack("<ii", -0x80000000, -0x80000000))),
        "BMP offset": ("a.bmp", patched(bmp, 10, b"\xff\xff\xff\xff")), "BMP cut": ("a.bmp", bmp[:60]),
        "BMP depth": ("a.bmp", patched(bmp, 28, b"\xff\xff")),
        "TIFF cut": ("a.tiff", tiff[:40]), "TIFF loop": ("a.tiff", tiff_loop), "TIFF strips": ("a.tiff", tiff_strips),
        "WebP cut": ("a.webp", webp[:30]), "WebP size": ("a.webp", patched(webp, 4, b"\xff\xff\xff\xff")),
        "WebP animation": ("a.webp", b"RIFF\x1e\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\xff\xff\xff\xff\xff\xff"),
        "EXR head": ("a.exr", b"v/1\x01"), "EXR version": ("a.exr", b"v/1\x01\xff\xff\xff\xff" + bytes(100)),
        "EXR attribute": ("a.exr", b"v/1\x01\x02\0\0\0channels\0chlist\0\xff\xff\xff\x7f"),
        "HDR size": ("a.hdr", HDR % (b"", 0x7fffffff, 0x7fffffff)), "HDR cut": ("a.hdr", HDR % (b"", 1024, 1024)),
        "HDR head": ("a.hdr", b"#?RADIANCE\n" + 100000 * b"EXPOSURE=1e-30\n"), "HDR line": ("a.hdr", b"#?" + bytes(1 << 20)),
        "HDR run": ("a.hdr", HDR % (b"", 1, 4096) + b"\x80\x80\x80\x80" + 4 * b"\1\1\1\xff"),
        "HDR nothing": ("a.hdr", HDR % (b"", 1, 4096) + b"\x80\x80\x80\x80" + 100000 * b"\1\1\1\0"),
        "HDR exposure": ("a.hdr", HDR % (b"EXPOSURE=1e-30\n", 1, 1) + b"\xff\xff\xff\xff"),
        "SVG": ("a.png", b"<svg xmlns='http://www.w3.org/2000/svg'><image href='file:///etc/passwd'/></svg>"),
        "playlist": ("a.png", b"#EXTM3U\n#EXTINF:1,\n/etc/passwd\n"), "GIF": ("a.png", b"GIF89a" + bytes(40)),
        "PDF": ("a.png", b"%PDF-1.4\n"), "zip": ("a.png", b"PK\x03\x04" + bytes(100)),
    }
    for i, (label, (name, data)) in enumerate(files.items()):
        codes = REFUSED + OK if label in ("JPEG segments", "BMP offset", "WebP size") else REFUSED
        yield asset("pictures", ("atlas", "floor", "sky")[i % 3], label, name, data, codes, smoke=label == "JPEG cut")


def mp4():
    return subprocess.run("ffmpeg -v error -f lavfi -i testsrc=size=32x32:rate=5 -t 2 -movflags frag_keyframe+empty_moov "
                          "-f mp4 -".split(), check=True, capture_output=True).stdout


def videos():
    whole = []

    def of(change):
        def make():
            if not whole:
                whole.append(mp4())
            return change(whole[0])
        return make
    gif = encoded("GIF")
    files = {
        "cut": ("a.mp4", of(lambda d: d[:len(d) // 2])), "head": ("a.mp4", of(lambda d: d[:40])),
        "size of a box": ("a.mp4", of(lambda d: b"\xff\xff\xff\xff" + d[4:])),
        "no size": ("a.mp4", of(lambda d: patched(d, d.index(b"avc1") + 28, bytes(4)))),
        "large": ("a.mp4", of(lambda d: patched(d, d.index(b"avc1") + 28, b"\xff\xff\xff\xff"))),
        "reference": ("a.mov", of(lambda d: d.replace(b"url \0\0\0\x01", b"url \0\0\0\0"))),
        "alias": ("a.mov", of(lambda d: d.replace(b"url \0\0\0\x01", b"alis\0\0\0\0"))),
        "short": ("a.mp4", of(lambda d: d), ), "noise": ("a.mp4", of(lambda d: d[:600] + bytes(i * 7 & 255 for i in range(len(d) - 600)))),
        "empty": ("a.mp4", b""), "playlist": ("a.mp4", b"#EXTM3U\n#EXTINF:1,\nfile:///etc/passwd\n"),
        "HLS": ("a.mkv", b"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nhttp://127.0.0.1:1/a.ts\n#EXT-X-ENDLIST\n"),
        "concat": ("a.mp4", b"ffconcat version 1.0\nfile /etc/passwd\n"), "SDP": ("a.mp4", b"v=0\nc=IN IP4 127.0.0.1\nm=video 9 RTP/AVP 26\n"),
        "DASH": ("a.mp4", b"<?xml version='1.0'?><MPD><BaseURL>file:///etc/passwd</BaseURL></MPD>"),
        "GIF without an end": ("a.gif", gif[:-1]), "GIF size": ("a.gif", patched(gif, 6, b"\xff\xff\xff\xff")),
        "Matroska": ("a.mkv", b"\x1a\x45\xdf\xa3" + b"\xff" * 100), "AVI": ("a.avi", b"RIFF\xff\xff\xff\x7fAVI LIST" + bytes(100)),
        "picture": ("a.mp4", png()), "APNG": ("a.apng", png(before=chunk(b"acTL", struct.pack(">II", 0xffffffff, 0)))),
    }
    for label, (name, data) in files.items():
        codes = REFUSED + OK if label in ("reference", "alias", "noise") else REFUSED
        yield asset("videos", "cells", label, name, data, codes, smoke=label in ("playlist", "cut"))


def rows():
    return [*pngs(), *others(), *videos()]
