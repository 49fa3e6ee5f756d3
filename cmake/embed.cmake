# SPDX-FileCopyrightText: 2026 The libscan authors
# SPDX-License-Identifier: Apache-2.0
# Files that a program carries in itself.
#
# As a script (cmake -DOUTPUT=x.cpp -DFUNCTION=name -DFILES=a;b -P embed.cmake) it writes a source
# that defines scan::FUNCTION() -> the files with their texts and the SHA-256 of each. Included, it
# gives scan_embed(TARGET FUNCTION FILES...), which does so whenever one of the files changes.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(LIBSCAN_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(scan_embed target function)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_${function}.cpp)
    add_custom_command(OUTPUT ${source} DEPENDS ${ARGN} ${LIBSCAN_EMBED_SCRIPT} VERBATIM
                       COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DFUNCTION=${function}
                               "-DFILES=${ARGN}" -P ${LIBSCAN_EMBED_SCRIPT})
    target_sources(${target} PRIVATE ${source})
  endfunction()
  return()
endif()

set(entries "")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  file(SHA256 ${file} sha256)
  string(APPEND entries "      {\"${name}\", R\"libscan(${text})libscan\",\n       \"${sha256}\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"tools/report/embedded.h\"

namespace scan {

const std::vector<EmbeddedFile>& ${FUNCTION}() {
  static const std::vector<EmbeddedFile> files = {
${entries}  };
  return files;
}

}  // namespace scan
")
