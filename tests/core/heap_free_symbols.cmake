# core has no heap and no exceptions: its archives may not even refer to them.
# cmake -DNM=... "-DARCHIVES=a.a;b.a" -P heap_free_symbols.cmake
set(forbidden "operator new|operator delete| malloc$| calloc$| realloc$| free$| aligned_alloc$| posix_memalign$|__cxa_throw|__cxa_allocate_exception|__cxa_begin_catch")
set(bad "")
foreach(archive ${ARCHIVES})
  execute_process(COMMAND ${NM} --undefined-only --demangle --print-file-name ${archive}
                  OUTPUT_VARIABLE symbols RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${NM} failed on ${archive}")
  endif()
  string(REPLACE "\n" ";" lines "${symbols}")
  foreach(line ${lines})
    # Deleting destructors of classes with virtual destructors refer to operator delete without
    # calling it; core's interfaces have no such destructors, so there is no exception to the rule.
    if(line MATCHES "${forbidden}")
      string(APPEND bad "  ${line}\n")
    endif()
  endforeach()
endforeach()
if(bad)
  message(FATAL_ERROR "core refers to the heap or to exceptions:\n${bad}")
endif()
list(LENGTH ARCHIVES count)
message("${count} archives of core refer to neither heap nor exceptions")
