// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// JPEG by libturbojpeg.
#include <turbojpeg.h>

#include <memory>
#include <new>

#include "libscan/core/error.h"
#include "libscan/io/image_codecs.h"

namespace scan {

// The luminance that a JPEG stores is 0.299 R + 0.587 G + 0.114 B (JFIF 1.02): it is taken as it
// is.
Image<std::uint8_t> decode_jpeg_grey8(std::string_view bytes, const std::string& name) {
  const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
  if (!decoder) throw std::bad_alloc();
  const auto fail = [&] {
    throw Error(Trouble::input, name + ": broken JPEG: " + tjGetErrorStr2(decoder.get()));
  };
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling,
                          &colours) != 0)
    fail();
  if (width < 1 || height < 1) fail();
  check_image_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), name);
  if (colours == TJCS_CMYK || colours == TJCS_YCCK)
    throw Error(Trouble::input, name + ": is a CMYK JPEG; grey or RGB is needed");
  Image<std::uint8_t> image(width, height);
  if (tjDecompress2(decoder.get(), data, bytes.size(), image.pixels.data(), width, 0, height,
                    TJPF_GRAY, TJFLAG_ACCURATEDCT) != 0)
    fail();
  return image;
}

}  // namespace scan
